#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/batch_objective.hpp"
#include "hypotrack/objective.hpp"
#include "hypotrack/refines_start.hpp"
#include "session/term_times.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Wraps a plugin's objective: names it in what it throws and where it crashes, checks its
/// costs and residuals, and measures how long it works.
class CheckedObjective final : public Objective,
                               public ResidualTerm,
                               public RefinesStart,
                               public BatchObjective {
 public:
  /// `who`: plugin_label() of the objective, which must not be null.
  CheckedObjective(std::unique_ptr<Objective> objective, std::string who);

  /// Returns how long the objective has worked so far; grows.
  std::shared_ptr<const TermTimes> times() const { return times_; }

  // Objective
  bool needs_rendering() const override { return objective_->needs_rendering(); }
  ImageUse image_use() const override { return objective_->image_use(); }
  void prepare(const Observation& observation) override;
  /// Throws PluginError if the cost is NaN or -infinity. So does cost_and_residuals().
  double cost(const RenderedHypothesis& hypothesis) const override;
  const ResidualTerm* residual_term() const override { return residuals_ ? this : nullptr; }
  /// Throws PluginError if a residual is not finite although the cost is.
  double cost_and_residuals(const RenderedHypothesis& hypothesis,
                            std::span<float> residuals) const override;
  bool has_maps() const override { return objective_->has_maps(); }
  std::vector<PixelMap> maps(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> on_device() const override;

  // RefinesStart
  /// Returns that of an objective that does not refine starts, too: empty. Throws PluginError on
  /// a state of another size, or not finite.
  Eigen::VectorXd refined_start() const override;

  // BatchObjective
  int most_at_once() const override { return batched_ ? batched_->most_at_once() : 0; }
  /// Throws PluginError as cost() does.
  void costs(std::span<const RenderedHypothesis> hypotheses,
             std::span<double> costs) const override;

  // ResidualTerm
  /// Throws PluginError if the number is negative, or more than memory can hold.
  std::int64_t residual_count() const override;
  /// Throws PluginError if a residual is not finite. So does write_slopes().
  void write_residuals(const RenderedHypothesis& hypothesis,
                       std::span<float> residuals) const override;
  bool has_slopes() const override { return residuals_->has_slopes(); }
  std::span<const int> pixel_views() const override;
  void write_slopes(const RenderedHypothesis& hypothesis, std::size_t i, std::span<float> residuals,
                    std::span<float> slopes) const override;
  bool has_jacobian() const override { return residuals_->has_jacobian(); }
  /// Throws PluginError if residuals or Jacobian are not finite, or the Jacobian's size is another.
  void write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                      Jacobian& jacobian) const override;

 private:
  double checked(double cost) const;
  void check_finite(std::span<const float> numbers, const char* what) const;

  std::unique_ptr<Objective> objective_;
  const ResidualTerm* residuals_;      ///< of the objective; null: none
  const RefinesStart* refines_start_;  ///< the objective; null: it does not
  const BatchObjective* batched_;      ///< the objective; null: it is not
  Eigen::Index dimension_ = 0;         ///< of the prepared frame's state
  std::string who_;
  std::shared_ptr<TermTimes> times_ = std::make_shared<TermTimes>();
};

}  // namespace internal
}  // namespace hypotrack
