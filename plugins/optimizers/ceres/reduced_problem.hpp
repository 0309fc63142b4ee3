#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <exception>
#include <optional>

#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/offset_space.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

/// D residuals r and their DxD Jacobian J.
struct ReducedResiduals {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// Returns the residuals that have these normal equations: J^T J = a and J^T r = g. Their squares
/// sum to the part of the cost that steps can change. The matrix may be singular.
ReducedResiduals reduce(const NormalEquations& equations);

/// A cost as a least-squares problem of few residuals: those of reduce() and one more, so that half
/// the sum of squares is half the cost plus a constant. Steps, costs and gradients are those of the
/// full residuals, which stay where they are computed.
///
/// Points are offsets from the start in units of the region's spread, over the free dimensions.
/// This class evaluates at most the budget and keeps the best point.
class ReducedProblem {
 public:
  /// The arguments must outlive the problem. Precondition: the cost has residuals.
  ReducedProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                 const LinearizationParams& params);

  /// Returns the offsets from the start, with the bounds.
  const OffsetSpace& space() const { return space_; }
  /// Returns the number of residuals: one more than free dimensions.
  int residual_count() const { return space_.dimension() + 1; }
  /// Returns the offsets of the last call of evaluate().
  const Eigen::VectorXd& last_offsets() const { return last_offsets_; }
  /// Returns the number of evaluations left.
  std::int64_t remaining() const { return limit_ - best_.result().evaluations; }
  /// Returns true once the budget does not suffice to go on.
  bool finished() const { return finished_ || error_ || remaining() <= 0 || deadline_.passed(); }

  /// Evaluates the start. Throws what the cost throws.
  void evaluate_start();
  /// Computes residuals and, unless null, their Jacobian (row by row). Where the cost is infinite
  /// or the budget does not suffice it returns false or, if a Jacobian is wanted, zeros: they end
  /// the search without a complaint on stderr. Never throws: an exception of the cost waits for
  /// rethrow().
  bool evaluate(const double* offsets, double* residuals, double* jacobian);
  /// Throws the exception that a cost threw during the search, unchanged.
  void rethrow() const;

  const OptimizerResult& result() const { return best_.result(); }

 private:
  bool try_evaluate(const double* offsets, double* residuals, double* jacobian);
  /// Returns whether so many evaluations are left; otherwise the search is finished.
  bool affords(std::int64_t evaluations);

  const std::int64_t limit_;
  const Deadline deadline_;
  OffsetSpace space_;
  const Eigen::VectorXd start_;
  BestSoFar best_;
  Linearizer linearizer_;
  Eigen::VectorXd last_offsets_;
  double last_cost_ = 0;         ///< of the last point evaluated
  std::optional<double> shift_;  ///< added to costs, which may be below the sum of squares
  bool finished_ = false;
  std::exception_ptr error_;
};

}  // namespace hypotrack
