#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/objective.hpp"

namespace hypotrack {

/// Residuals of one term.
struct TermRows {
  Eigen::Index count;
  bool draws;  ///< whether it looks at pictures
};
/// Those of terms that look at no picture, where others do (Evaluator::pose_only_residuals()).
std::vector<ResidualRows> pose_only_rows(const std::vector<TermRows>& terms);

/// The residuals of several terms, one after the other, each times the square root of its weight:
/// the sum of squares of all is the weighted sum of theirs. Terms of weight 0 have none.
class TermResiduals {
 public:
  /// Why these terms are no sum of squares, and what to do; empty if they are one.
  static std::string why_none(const std::vector<ObjectiveTerm>& terms);

  /// The terms must be a sum of squares.
  explicit TermResiduals(const std::vector<ObjectiveTerm>& terms);

  /// Asks the terms for the counts of the frame that they are prepared for.
  void prepare();
  Eigen::Index count() const { return count_; }
  /// Evaluator::pose_only_residuals().
  std::vector<ResidualRows> pose_only() const;
  /// Cost of one of the terms, without its weight; its residuals go to the front of `rest`, which
  /// then begins behind them. May be called from several threads at once.
  double write(std::size_t term, const RenderedHypothesis& hypothesis,
               std::span<float>& rest) const;

 private:
  struct Part {
    const Objective* objective;
    float factor;
    std::size_t count = 0;
  };
  std::vector<Part> parts_;  // one per term
  Eigen::Index count_ = 0;
};

}  // namespace hypotrack
