#pragma once

#include <cstdint>

#include "hypotrack/optimizer.hpp"
#include "levenberg_marquardt_params.hpp"

namespace hypotrack {

/// Damped least squares (K. Levenberg, "A method for the solution of certain non-linear problems in
/// least squares", 1944; D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear
/// parameters", 1963) on the residuals r of the cost, in units of the region's spread:
///
///   (A + mu (diag(A) + mean_share mean(diag(A)) I)) dx = -J^T r,   A = J^T J
///
/// J from ResidualCost::linearize where the cost has that; otherwise by forward differences (one
/// evaluation per number), their sign alternating from Jacobian to Jacobian, inwards at bounds.
/// With each Jacobian, `trials` steps of different mu are evaluated together; the one of lowest
/// cost is taken if it is below the cost so far, and its mu is the middle of the next. If none is,
/// more damped ones are tried; if neither they nor (of differences) a Jacobian of the other sign
/// helps, differences or the blur of silhouettes are halved, so that what is coarse is found first
/// and what is fine afterwards. Numbers at a bound that want to leave stay there, the others are
/// solved for without them. No number moves farther than its spread in one step.
///
/// It refines: what is many pixels off is beyond what residuals of pixels tell.
class LevenbergMarquardt : public Optimizer {
 public:
  explicit LevenbergMarquardt(const LevenbergMarquardtParams& params) : params_(params) {}

  bool needs_residuals() const override { return true; }
  Linearization linearization() const override;
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  /// Throws ConfigError if the cost has no residuals. No step is made from where they are not
  /// finite, which they should be wherever the cost is.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  LevenbergMarquardtParams params_;
};

}  // namespace hypotrack
