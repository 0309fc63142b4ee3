#include "random_search.hpp"

#include <algorithm>

#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

OptimizerResult RandomSearch::minimize(CostFunction& cost, const SearchRegion& region,
                                       const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const std::int64_t limit = budget.evaluations;

  const StartPoints samples(region, params_.start, seed);
  BestSoFar best;
  while (best.result().evaluations < limit) {
    const std::int64_t done = best.result().evaluations;
    if (done > 0 && deadline.passed()) break;
    const auto count = std::min<std::int64_t>(params_.batch, limit - done);
    const Eigen::MatrixXd points = samples.points(done, count);
    Eigen::VectorXd costs(count);
    cost.evaluate(points, costs);
    best.update(points, costs);
  }
  return best.result();
}

}  // namespace hypotrack
