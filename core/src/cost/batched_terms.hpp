#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The terms that score many hypotheses in one call (Objective::costs()), with the drawings of a
/// block.
class BatchedTerms {
 public:
  explicit BatchedTerms(const std::vector<ObjectiveTerm>& terms);

  bool any() const { return most_ > 0; }
  bool has(std::size_t term) const { return batched_[term]; }
  /// Returns the most hypotheses of a block.
  Eigen::Index most() const { return most_; }

  /// Begins a block of `count` hypotheses.
  void begin(Eigen::Index count);
  /// Copies a hypothesis of the block. Several threads may copy different ones.
  void keep(Eigen::Index index, const RenderedHypothesis& hypothesis);
  /// Adds the weighted costs of the block to `costs`. Throws Error, naming the term, if a sum is
  /// NaN.
  void add(Eigen::Ref<Eigen::VectorXd> costs) const;

 private:
  struct Drawing {
    std::vector<double> state;
    std::vector<std::vector<float>> pixels;  ///< by view
    std::vector<DepthTile> views;
  };

  const std::vector<ObjectiveTerm>& terms_;
  std::vector<bool> batched_;  ///< by term
  Eigen::Index most_ = 0;
  std::vector<Drawing> drawings_;
  Eigen::Index count_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
