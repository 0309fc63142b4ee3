#pragma once

#include <nlopt.h>

#include <Eigen/Core>
#include <cstdint>
#include <exception>
#include <optional>

#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/offset_space.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

/// Adapts a cost function to NLopt. NLopt sees the dimensions that the bounds leave free, as
/// offsets from the start in units of the region's spread; the start is the origin.
///
/// Whatever NLopt does, this class evaluates at most the budget, within the bounds, and keeps the
/// best point. The first evaluation is the start.
class ScaledProblem {
 public:
  /// All arguments must outlive the problem.
  ScaledProblem(CostFunction& cost, const SearchRegion& region, const Budget& budget);

  /// Gives algorithms the gradient 2 J^T r. Precondition: the cost has residuals, and nothing was
  /// evaluated.
  void use_gradient(const LinearizationParams& params);

  /// Returns the number of free dimensions.
  int dimension() const { return space_.dimension(); }
  /// Returns the number of evaluations left.
  std::int64_t remaining() const { return limit_ - best_.result().evaluations; }
  /// Returns bounds in NLopt's units, at most `box` from the start; +-box may be infinite.
  Eigen::VectorXd lower(double box) const { return space_.lower(box); }
  Eigen::VectorXd upper(double box) const { return space_.upper(box); }

  /// Evaluates the start. Throws what the cost throws.
  void evaluate_start();
  /// Evaluates the cost as an nlopt_func; `data` is the ScaledProblem. Never throws: an exception
  /// of the cost stops NLopt and waits for rethrow(). The gradient is 0 where the cost is infinite,
  /// and where the budget does not suffice for it, which stops NLopt.
  static double callback(unsigned n, const double* offsets, double* gradient, void* data);
  /// Sets the run to stop when the budget is used up.
  void attach(nlopt_opt opt) { opt_ = opt; }
  /// Throws the exception that a cost threw during the search, unchanged.
  void rethrow() const;

  const OptimizerResult& result() const { return best_.result(); }

 private:
  double value(const double* offsets, Eigen::VectorXd* gradient);
  double evaluate(const Eigen::VectorXd& point);
  void add_gradient(Eigen::VectorXd& gradient);
  void stop();

  CostFunction& cost_;
  const SearchRegion& region_;
  const std::int64_t limit_;
  const Deadline deadline_;
  OffsetSpace space_;
  nlopt_opt opt_ = nullptr;
  BestSoFar best_;
  std::optional<Linearizer> linearizer_;
  double start_value_ = 0;
  double last_cost_ = 0;  ///< of the last point evaluated
  FiniteCosts finite_;
  std::int64_t calls_ = 0;       ///< of NLopt
  std::int64_t idle_calls_ = 0;  ///< calls without an evaluation
  bool stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace hypotrack
