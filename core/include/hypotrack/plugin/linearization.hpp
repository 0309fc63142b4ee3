#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

/// How the second of two cameras is turned against its calibration, judged by one frame.
struct CameraTurn {
  double angle = 0;     ///< radians about the rig's y axis; positive: towards the first camera
  double sigma = 0;     ///< its standard deviation
  double distance = 0;  ///< of the models from that camera, metres
};

/// An objective that judges each view by itself may also derive from this: views that contradict
/// each other then tell the tracker of a wrong calibration.
class HYPOTRACK_API CameraTurnTerm {
 public:
  virtual ~CameraTurnTerm() = default;

  /// Returns the turn that makes both views of the prepared frame agree on poses near a state.
  /// Returns nothing without two views, or if they show too little.
  virtual std::optional<CameraTurn> camera_turn(std::span<const double> state) const = 0;
};

// Helpers for optimizers that linearise residuals.

/// Returns steps for differences at a point: a share of the spread, inwards at bounds, 0 without
/// room. `sign` is the direction where both have room.
inline Eigen::VectorXd difference_steps(const SearchRegion& region, const Eigen::VectorXd& point,
                                        double share, double sign = 1) {
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(point.size());
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    const double wanted = share * region.spread[i];
    const double up = std::min(region.upper[i] - point[i], wanted);
    const double down = std::min(point[i] - region.lower[i], wanted);
    const bool ahead = sign > 0 ? up >= std::min(down, wanted) : up > down;
    const double h = ahead ? up : -down;
    if (std::abs(h) > 1e-3 * wanted) steps[i] = h;
  }
  return steps;
}

/// Returns a point with its neighbours at these steps.
inline Neighbourhood neighbourhood(const Eigen::VectorXd& point, const Eigen::VectorXd& steps,
                                   double blur) {
  Neighbourhood at{point.replicate(1, point.size() + 1), steps, blur};
  at.points.rightCols(point.size()).diagonal() += steps;
  return at;
}

/// Share of the spread for the steps of analytic Jacobians: surfaces move by a fraction of a pixel,
/// far above rounding.
constexpr double kAnalyticShare = 0.01;

/// Returns the share of the spread for linearize(): `difference`, that of numerical Jacobians, if
/// it draws the neighbours.
inline double linearize_share(const ResidualCost& residuals, double difference) {
  return residuals.draws_neighbours() ? difference : kAnalyticShare;
}

/// Returns normal equations in units of the region's spread.
inline NormalEquations per_spread(const NormalEquations& equations, const SearchRegion& region) {
  const auto spread = region.spread.asDiagonal();
  return {spread * equations.a * spread, spread * equations.g};
}

/// Returns the scale of differences that makes Jacobians per unit of the spread.
inline Eigen::VectorXd scale_per_spread(const SearchRegion& region, const Eigen::VectorXd& steps) {
  return (steps.array() == 0).select(0.0, region.spread.array() / steps.array());
}

/// Parameters of a Linearizer; an optimizer's parameter struct includes them.
struct LinearizationParams {
  double blur = 1.0;
  double difference = 0.02;
  void visit(ParamVisitor& v) {
    v("blur_px", blur,
      {.help = "for analytic Jacobians: width in pixels of the blur of silhouettes",
       .min = 1e-2,
       .max = 100});
    v("difference", difference,
      {.help =
           "for Jacobians by differences: their steps, as a share of the search region's spread",
       .min = 1e-6,
       .max = 1});
  }
};

/// Evaluates points one by one and linearises the residuals at the last of them: analytically where
/// the cost can, otherwise by differences. Keeps the best point and counts all evaluations.
class Linearizer {
 public:
  /// The arguments must outlive this object. Throws ConfigError if the cost has no residuals.
  Linearizer(CostFunction& cost, const SearchRegion& region, const LinearizationParams& params,
             BestSoFar& best)
      : cost_(cost), region_(region), params_(params), best_(best) {
    check_requirements({.least_squares = true}, cost.residuals(), cost.device());
    if (!cost.residuals()->can_linearize()) differences_ = cost.residuals()->differences();
  }

  /// Returns the evaluations that equations() takes.
  std::int64_t price() const {
    const Eigen::Index d = region_.start.size();
    return differences_ ? d : cost_.residuals()->linearize_price(d);
  }
  /// Returns the last point evaluated; empty before the first.
  const Eigen::VectorXd& point() const { return point_; }

  /// Returns the cost of a point; counts one evaluation.
  double evaluate(const Eigen::VectorXd& point) {
    Eigen::VectorXd cost(1);
    if (differences_) {
      differences_->evaluate(point, cost);
      differences_->move_to(0);
    } else {
      cost_.evaluate(point, cost);
    }
    point_ = point;
    best_.update(point, cost);
    return cost[0];
  }

  /// Returns the normal equations at point(), in units of the region's spread; counts price()
  /// evaluations. Precondition: the point's cost is finite.
  NormalEquations equations() {
    if (!differences_) {
      ResidualCost& residuals = *cost_.residuals();
      const double share = linearize_share(residuals, params_.difference);
      const Neighbourhood at =
          neighbourhood(point_, difference_steps(region_, point_, share), params_.blur);
      const NormalEquations found = residuals.linearize(at.points, at.steps, at.blur);
      best_.count(price());
      return per_spread(found, region_);
    }
    const Eigen::VectorXd steps = difference_steps(region_, point_, params_.difference);
    const Eigen::MatrixXd beside = neighbourhood(point_, steps, 0).points.rightCols(steps.size());
    Eigen::VectorXd costs(steps.size());
    const NormalEquations found =
        differences_->normal_equations(beside, scale_per_spread(region_, steps), costs);
    best_.update(beside, costs);
    return found;
  }

 private:
  CostFunction& cost_;
  const SearchRegion& region_;
  const LinearizationParams params_;
  BestSoFar& best_;
  std::unique_ptr<ResidualDifferences> differences_;  ///< null: the cost linearises
  Eigen::VectorXd point_;
};

/// Searches from the region's start or, where that is infeasible and gives no derivatives, from its
/// best neighbour at a share of the spread. `search(region, budget)` evaluates the start first.
template <class Search>
OptimizerResult from_feasible_start(CostFunction& cost, const SearchRegion& region,
                                    const Budget& budget, double share, const Search& search) {
  const Deadline deadline(budget.seconds);
  OptimizerResult first = search(region, budget);
  const std::int64_t left = budget.evaluations - first.evaluations - region.start.size();
  if (std::isfinite(first.cost) || left < 1 || deadline.passed()) return first;
  const Eigen::VectorXd steps = difference_steps(region, region.start, share);
  const Eigen::MatrixXd beside =
      neighbourhood(region.start, steps, 0).points.rightCols(steps.size());
  Eigen::VectorXd costs(steps.size());
  cost.evaluate(beside, costs);
  first.evaluations += steps.size();
  Eigen::Index best = 0;
  if (!std::isfinite(costs.minCoeff(&best))) return first;
  SearchRegion from = region;
  from.start = beside.col(best);
  OptimizerResult found = search(from, Budget{left, deadline.left(), budget.usual_cost});
  found.evaluations += first.evaluations;
  return found;
}

}  // namespace hypotrack
