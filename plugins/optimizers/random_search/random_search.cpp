#include "random_search.hpp"

#include <algorithm>

#include "hypotrack/random.hpp"
#include "hypotrack/search.hpp"

namespace hypotrack {
namespace {

constexpr std::uint32_t kSampleStream = 1;

Eigen::VectorXd sample(const SearchRegion& region, double sigma, std::int64_t number,
                       std::uint64_t seed) {
  Eigen::VectorXd point = region.start;
  if (number == 0) return point;
  for (Eigen::Index d = 0; d < point.size(); ++d) {
    point[d] += sigma * region.spread[d] *
                normal(seed, {static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(number), 0,
                              kSampleStream});
  }
  return within_bounds(point, region);
}

}  // namespace

OptimizerResult RandomSearch::minimize(CostFunction& cost, const SearchRegion& region,
                                       const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  const std::int64_t limit = budget.evaluations;

  BestSoFar best;
  while (best.result().evaluations < limit) {
    const std::int64_t done = best.result().evaluations;
    if (done > 0 && deadline.passed()) break;
    const auto count = std::min<std::int64_t>(params_.batch, limit - done);
    Eigen::MatrixXd points(region.start.size(), count);
    for (std::int64_t i = 0; i < count; ++i) {
      points.col(i) = sample(region, params_.sigma, done + i, seed);
    }
    Eigen::VectorXd costs(count);
    cost.evaluate(points, costs);
    best.update(points, costs);
  }
  return best.result();
}

}  // namespace hypotrack
