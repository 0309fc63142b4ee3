#pragma once

#include <cstdint>
#include <span>

#include "base/exported.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Adds a constant cost for every covered pixel of the first view. A sum over pixels rewards
/// covering more of them, so a free size grows without limit. With a penalty, covering a pixel pays
/// only if it explains more than that.
class Coverage final : public Objective, public ResidualTerm {
 public:
  /// Sets the penalty of every covered pixel, >= 0.
  void set_penalty(double penalty) { penalty_ = penalty; }
  double penalty() const { return penalty_; }

 private:
  void do_prepare(const Observation& observation) override;
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return count_; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;

  double penalty_ = 0;
  std::int64_t count_ = 0;
};

/// Returns the number of covered pixels of a view.
std::int64_t covered_pixels(const DepthTile& tile);

}  // namespace internal
}  // namespace hypotrack
