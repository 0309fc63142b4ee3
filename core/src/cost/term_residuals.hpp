#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Number of residuals of one term.
struct TermRows {
  Eigen::Index count;
  bool draws;  ///< whether it reads images
};
/// Returns the residuals of terms that read no images, if other terms do
/// (StateResiduals::pose_only()).
std::vector<ResidualRows> pose_only_rows(const std::vector<TermRows>& terms);

/// The concatenated residuals of several terms, each times the square root of its weight. The sum
/// of squares is the weighted sum of the terms' sums. Terms of weight 0 have none.
class TermResiduals {
 public:
  /// Returns why these terms are not a sum of squares and what to do; empty if they are.
  static std::string why_none(const std::vector<ObjectiveTerm>& terms);

  /// The terms must be a sum of squares.
  explicit TermResiduals(const std::vector<ObjectiveTerm>& terms);

  /// Reads the terms' residual counts for the frame that they are prepared for.
  void prepare();
  Eigen::Index count() const { return count_; }
  /// See StateResiduals::pose_only().
  std::vector<ResidualRows> pose_only() const;
  /// Writes one term's residuals to their place among `all`, and returns the term's cost without
  /// its weight. May be called from several threads at once.
  double write(std::size_t term, const RenderedHypothesis& hypothesis, std::span<float> all) const;

 private:
  struct Part {
    const Objective* objective;
    float factor;
    std::size_t first = 0, count = 0;
  };
  std::vector<Part> parts_;  // one per term
  Eigen::Index count_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
