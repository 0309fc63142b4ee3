#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hypotrack/plugin/optimizer.hpp"
#include "levenberg_marquardt_params.hpp"

namespace hypotrack {

/// Damped least squares (K. Levenberg, "A method for the solution of certain non-linear problems in
/// least squares", 1944; D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear
/// parameters", 1963) on the residuals r of the cost, in units of the region's spread:
///
///   (A + mu (diag(A) + mean_share mean(diag(A)) I)) dx = -J^T r,   A = J^T J
///
/// J comes from ResidualCost::linearize() if the cost has it. Otherwise it comes from forward
/// differences, one evaluation per dimension. Their sign alternates from Jacobian to Jacobian; at
/// bounds they go inwards.
///
/// With each Jacobian, `trials` steps of different mu are evaluated together. The step of lowest
/// cost is taken if it improves, and its mu is the middle of the next trials. Otherwise steps with
/// more damping are tried, then (numerically) a Jacobian of the other sign. If that fails, too, the
/// differences or the blur of silhouettes are halved, so that the search goes from coarse to fine.
/// Dimensions that want to cross a bound stay there; the others are solved without them. No
/// dimension moves farther than its spread in one step.
///
/// With `starts` N, N searches begin at the region's start and at samples about it, each with an
/// N-th of the evaluations; the best result counts.
///
/// Steps with analytic Jacobians stay on the GPU if the cost can do that (DescentCost::descend())
/// and nothing watches the search: the same steps, up to rounding.
///
/// It is a local refinement: pixel residuals do not guide it over errors of many pixels.
class LevenbergMarquardt : public Optimizer {
 public:
  explicit LevenbergMarquardt(const LevenbergMarquardtParams& params) : params_(params) {}

  Requirements requirements() const override;
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  /// Searches the region. Throws ConfigError if the cost lacks the requirements. Makes no step from
  /// a point whose residuals are not finite; they should be wherever the cost is.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;
  /// Searches with analytic Jacobians go in step, one batch for all.
  std::vector<OptimizerResult> minimize_each(CostFunction& cost,
                                             std::span<const SearchRegion> regions,
                                             const Budget& budget, std::uint64_t seed) override;

 private:
  bool is_analytic(const ResidualCost& residuals) const;
  /// Searches every region from its start.
  std::vector<OptimizerResult> search_each(CostFunction& cost,
                                           std::span<const SearchRegion> regions,
                                           const Budget& budget) const;
  /// Searches every region from all its starts, which are drawn with the region's seed.
  std::vector<OptimizerResult> search_from_starts(CostFunction& cost,
                                                  std::span<const SearchRegion> regions,
                                                  const Budget& budget,
                                                  const std::vector<std::uint64_t>& seeds) const;

  LevenbergMarquardtParams params_;
};

}  // namespace hypotrack
