#pragma once

#include <exception>
#include <memory>

#include "arrays.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack::python {

/// Ends a search in Python whose budget is spent. Python code lets it pass.
class BudgetSpent : public std::exception {
 public:
  const char* what() const noexcept override {
    return "the budget of this search is spent: let this exception pass";
  }
};

/// The cost of a search, for an optimizer in Python. It keeps the best point, within the bounds and
/// the budget. Python may keep the object: after the search it refuses its work.
class BudgetedCost {
 public:
  BudgetedCost(CostFunction& cost, const SearchRegion& region, const Budget& budget);

  /// Computes the costs (N) of points (DxN), which are moved into the bounds. Throws BudgetSpent if
  /// there are more than the budget has left. The caller has no GIL.
  Eigen::VectorXd evaluate(Eigen::MatrixXd points);
  /// Computes the residuals (MxN) as well.
  Eigen::MatrixXf residuals(Eigen::MatrixXd points);
  /// Computes the analytic normal equations at a point. Counts as linearize_price().
  NormalEquations linearize(const Eigen::VectorXd& point, double blur);

  bool has_residuals() const { return cost().residuals() != nullptr; }
  bool can_linearize() const { return has_residuals() && cost().residuals()->can_linearize(); }
  Eigen::Index dimension() const { return region_.start.size(); }
  std::int64_t left() const { return budget_.evaluations - best_.result().evaluations; }
  const OptimizerResult& best() const { return best_.result(); }
  const SearchRegion& region() const { return region_; }
  const Budget& budget() const { return budget_; }
  /// Returns what the cost threw; null: nothing.
  const std::exception_ptr& failure() const { return failure_; }
  /// Ends the search: the cost is about to go. Waits for a thread of Python that evaluates still.
  void end();

 private:
  CostFunction& cost() const;
  void spend(std::int64_t evaluations) const;
  template <class Function>
  auto keeping_failure(const Function& function);

  CostFunction* cost_;
  SearchRegion region_;
  Budget budget_;
  Deadline deadline_;
  BestSoFar best_;
  std::exception_ptr failure_;
  std::atomic<bool> busy_ = false;
};

}  // namespace hypotrack::python
