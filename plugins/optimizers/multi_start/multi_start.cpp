#include "multi_start.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
namespace {

/// Returns the indices of the lowest costs, lowest first; the earlier of equal ones.
std::vector<Eigen::Index> lowest(const Eigen::VectorXd& costs, std::int64_t count) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(costs.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return costs[i]; });
  order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
  return order;
}

}  // namespace

MultiStart::MultiStart(const MultiStartParams& params, std::unique_ptr<Optimizer> optimizer,
                       const std::string& where)
    : params_(params), optimizer_(std::move(optimizer)) {
  if (params.candidates < params.restarts) {
    throw ConfigError(where + ": multi_start: restarts is " + std::to_string(params.restarts) +
                      ", expected at most the " + std::to_string(params.candidates) +
                      " candidates that they are the best of");
  }
}

OptimizerResult MultiStart::minimize(CostFunction& cost, const SearchRegion& region,
                                     const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const auto count = std::min<std::int64_t>(params_.candidates, budget.evaluations);
  const Eigen::MatrixXd candidates = StartPoints(region, params_.around, seed).points(0, count);
  Eigen::VectorXd costs(count);
  cost.evaluate(candidates, costs);
  BestSoFar first;
  first.update(candidates, costs);
  OptimizerResult best = first.result();

  const std::int64_t left = budget.evaluations - best.evaluations;
  if (left == 0 || deadline.passed()) return best;
  const std::vector<Eigen::Index> starts =
      lowest(costs, std::min<std::int64_t>(params_.restarts, left));
  const std::int64_t evaluations = left / static_cast<std::int64_t>(starts.size());
  std::vector<SearchRegion> regions;
  for (const Eigen::Index start : starts) {
    regions.push_back(region);
    regions.back().spread *= params_.spread;
    regions.back().start = candidates.col(start);
  }
  for (const OptimizerResult& found : optimizer_->minimize_each(
           cost, regions, {evaluations, deadline.left(), budget.usual_cost}, seed)) {
    const std::int64_t all = best.evaluations + found.evaluations;
    if (found.cost < best.cost) best = found;
    best.evaluations = all;
  }
  return best;
}

}  // namespace hypotrack
