#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/search.hpp"
#include "levenberg_marquardt_params.hpp"

namespace hypotrack {

/// One search of LevenbergMarquardt, step by step: the caller evaluates and linearises what it asks
/// for. It moves in units of the region's spread.
class DampedLeastSquares {
 public:
  /// What the search waits for.
  enum class Wants { costs, equations, nothing };

  /// Where the equations come from.
  enum class Source {
    differences,  ///< of all residuals
    analytic,     ///< linearize(), of one drawn point
    mixed,        ///< linearize(), which also draws the neighbours
  };

  /// The region must outlive the search.
  DampedLeastSquares(const SearchRegion& region, std::int64_t evaluations,
                     const LevenbergMarquardtParams& params, Source source);

  Wants wants() const { return wants_; }

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
  std::int64_t remaining() const { return evaluations_ - best_.result().evaluations; }
  Eigen::VectorXd step(double damping) const;
  void move_to(Eigen::Index point, const Eigen::VectorXd& costs);
  /// Returns the evaluations that the next equations take.
  std::int64_t price() const;
  void want_equations();
  void want_trials(int round);
  void end_of_steps(bool gained);

  const SearchRegion& region_;
  const std::int64_t evaluations_;
  const LevenbergMarquardtParams params_;
  const Source source_;
  BestSoFar best_;
  Wants wants_ = Wants::costs;

  Eigen::VectorXd x_;  ///< current point
  double cost_at_x_ = 0;
  double sign_ = 1;      ///< of the differences
  double fineness_ = 1;  ///< of differences or blur, as a share of the first
  Damping damping_;
  NormalEquations equations_;  ///< at x, per spread
  Eigen::MatrixXd points_;     ///< the start, or trial steps
  int round_ = -1;             ///< of trial steps; -1: the start
  double lowest_ = 0;          ///< damping of the first trial step
  int jacobians_ = 0, failed_ = 0;
};

}  // namespace hypotrack
