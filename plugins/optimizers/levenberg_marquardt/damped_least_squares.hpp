#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "hypotrack/gpu/damped_steps.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/search.hpp"
#include "levenberg_marquardt_params.hpp"

namespace hypotrack {

/// One search of LevenbergMarquardt, step by step: the caller evaluates and linearises what it asks
/// for. It moves in units of the region's spread.
class DampedLeastSquares {
 public:
  using Wants = DampedSteps::Wants;

  /// Where the equations come from.
  enum class Source {
    differences,  ///< of all residuals
    analytic,     ///< linearize(), of one drawn point
    mixed,        ///< linearize(), which also draws the neighbours
  };

  /// The region must outlive the search.
  DampedLeastSquares(const SearchRegion& region, std::int64_t evaluations,
                     const LevenbergMarquardtParams& params, Source source);

  Wants wants() const { return steps_.wants; }

  /// Returns the points whose costs it wants.
  const Eigen::MatrixXd& points() const { return points_; }
  /// Takes the costs of points(). Returns the index of the point that the search moved to, or -1.
  Eigen::Index take(const Eigen::VectorXd& costs);

  /// Returns the point and neighbours whose equations it wants.
  Neighbourhood neighbourhood() const;
  /// Takes normal equations from linearize(); counts their evaluations.
  void take(const NormalEquations& equations);
  /// Takes normal equations from differences, and the costs of the neighbours, which count as
  /// evaluations. Returns the index of the neighbour that the search moved to, or -1.
  Eigen::Index take(const NormalEquations& equations, const Neighbourhood& at,
                    const Eigen::VectorXd& costs);

  const OptimizerResult& result() const { return best_.result(); }

 private:
  Eigen::VectorXd step(double damping) const;
  void move_to(Eigen::Index point) { x_ = points_.col(point); }
  void count(std::int64_t evaluations) { steps_.evaluations += evaluations; }
  /// Makes points() the trial steps that the search wants, if it wants any.
  void place_trials();

  const SearchRegion& region_;
  const Source source_;
  BestSoFar best_;
  DampedSteps steps_;
  Eigen::VectorXd x_;          ///< current point
  double sign_ = 1;            ///< of the differences
  NormalEquations equations_;  ///< at x, per spread
  Eigen::MatrixXd points_;     ///< the start, or trial steps
};

/// Returns the decisions' settings of a search in `dimension` dimensions.
DampedSettings damped_settings(const LevenbergMarquardtParams& params,
                               DampedLeastSquares::Source source, std::int64_t evaluations,
                               Eigen::Index dimension);

}  // namespace hypotrack
