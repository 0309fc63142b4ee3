#pragma once

#include <nlopt.h>

#include <Eigen/Core>
#include <cstdint>
#include <exception>

#include "hypotrack/offset_space.hpp"
#include "hypotrack/search.hpp"

namespace hypotrack {

/// Stands between NLopt and a cost function. NLopt sees the dimensions that the bounds leave free,
/// as offsets from the start in units of the region's spread; the start is the origin.
///
/// Whatever NLopt does, at most the budget's evaluations are made, all within the bounds, and the
/// best of them is kept here. The first one is the start.
class ScaledProblem {
 public:
  /// Everything given must outlive the problem.
  ScaledProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget);

  /// Number of free dimensions.
  int dimension() const { return space_.dimension(); }
  /// Evaluations that are left.
  std::int64_t remaining() const { return limit_ - best_.result().evaluations; }
  /// Bounds in NLopt's units, no further from the start than `box`; +-box may be infinite.
  Eigen::VectorXd lower(double box) const { return space_.lower(box); }
  Eigen::VectorXd upper(double box) const { return space_.upper(box); }

  /// Evaluates the start. Throws what the cost throws.
  void evaluate_start();
  /// An nlopt_func; `data` is the ScaledProblem. Never throws: an exception of the cost stops NLopt
  /// and waits in rethrow().
  static double callback(unsigned n, const double* offsets, double* gradient, void* data);
  /// The run to stop when the budget is used up.
  void attach(nlopt_opt opt) { opt_ = opt; }
  /// Throws the exception that a cost threw during the search, unchanged.
  void rethrow() const;

  const OptimizerResult& result() const { return best_.result(); }

 private:
  double value(const double* offsets);
  double evaluate(const Eigen::VectorXd& point);
  void stop();

  CostFunction& cost_;
  const SearchRegion& region_;
  const std::int64_t limit_;
  const Deadline deadline_;
  OffsetSpace space_;
  nlopt_opt opt_ = nullptr;
  BestSoFar best_;
  double start_value_ = 0;
  FiniteCosts finite_;
  std::int64_t calls_ = 0;       ///< of NLopt
  std::int64_t idle_calls_ = 0;  ///< those that cost no evaluation
  bool stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace hypotrack
