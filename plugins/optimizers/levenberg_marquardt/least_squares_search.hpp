#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "hypotrack/damping.hpp"
#include "hypotrack/search.hpp"
#include "levenberg_marquardt_params.hpp"

namespace hypotrack {

/// One search of LevenbergMarquardt. It moves in units of the region's spread.
class LeastSquaresSearch {
 public:
  /// All arguments must outlive the search.
  LeastSquaresSearch(CostFunction& cost, ResidualCost& residuals, const SearchRegion& region,
                     const Budget& budget, const LevenbergMarquardtParams& params);

  OptimizerResult run();

 private:
  std::int64_t remaining() const { return budget_.evaluations - best_.result().evaluations; }
  bool may_go_on() const;
  void evaluate();
  void evaluate_start();
  bool linearize();
  bool linearize_by_slopes();
  /// Returns steps of a share of the spread, inwards at bounds; 0 without room.
  Eigen::VectorXd differences(double share) const;
  bool try_steps();
  Eigen::VectorXd step(double damping) const;
  void move_to(Eigen::Index trial);
  void leave_infeasible();

  CostFunction& cost_;
  ResidualCost& residual_cost_;
  const SearchRegion& region_;
  const Budget budget_;
  const LevenbergMarquardtParams params_;
  const Deadline deadline_;
  BestSoFar best_;

  Eigen::VectorXd x_;  ///< current point
  double cost_at_x_ = 0;
  double sign_ = 1;  ///< of the differences
  const bool analytic_;
  const std::unique_ptr<ResidualDifferences> differences_;  ///< unless analytic_; moves with x_
  double fineness_ = 1;  ///< of differences or blur, as a share of the first
  Damping damping_;
  NormalEquations equations_;  ///< at x, per spread
  double moved_ = 0;           ///< largest component of the last step, in spreads

  // The last batch.
  Eigen::MatrixXd points_;
  Eigen::VectorXd costs_;
};

}  // namespace hypotrack
