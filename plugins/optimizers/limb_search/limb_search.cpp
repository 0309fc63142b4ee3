#include "limb_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hypotrack/plugin/random.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
namespace {

/// A limb, and its best place among the samples.
struct Limb {
  const std::vector<int>* dimensions;
  Eigen::VectorXd point = {};  ///< of the whole scene
  double cost = 0;
};

bool is_bounded(const SearchRegion& region, const std::vector<int>& dimensions) {
  return std::ranges::all_of(dimensions, [&](int d) {
    return std::isfinite(region.lower[d]) && std::isfinite(region.upper[d]);
  });
}

std::vector<Limb> limbs_of(const SearchRegion& region) {
  std::vector<Limb> limbs;
  for (const SearchGroup& group : region.groups) {
    if (group.kind == SearchGroup::Kind::limb && is_bounded(region, group.dimensions))
      limbs.push_back({&group.dimensions});
  }
  return limbs;
}

/// Returns the region's start (column 0), then `samples` points per limb with the limb elsewhere.
Eigen::MatrixXd sampled(const SearchRegion& region, const std::vector<Limb>& limbs,
                        std::int64_t samples, std::uint64_t seed) {
  const auto count = static_cast<std::int64_t>(limbs.size()) * samples;
  Eigen::MatrixXd points = region.start.replicate(1, count + 1);
  for (std::int64_t i = 0; i < count; ++i) {
    for (const int d : *limbs[static_cast<std::size_t>(i / samples)].dimensions) {
      const RandomIndex index{static_cast<std::uint32_t>(d), static_cast<std::uint32_t>(i)};
      points(d, i + 1) =
          region.lower[d] + uniform4(seed, index)[0] * (region.upper[d] - region.lower[d]);
    }
  }
  return points;
}

void take_best(std::vector<Limb>& limbs, const Eigen::MatrixXd& points,
               const Eigen::VectorXd& costs) {
  const Eigen::Index samples = (points.cols() - 1) / static_cast<Eigen::Index>(limbs.size());
  Eigen::Index first = 1;
  for (Limb& limb : limbs) {
    Eigen::Index best = 0;
    limb.cost = costs.segment(first, samples).minCoeff(&best);
    limb.point = points.col(first + best);
    first += samples;
  }
  std::ranges::stable_sort(limbs, {}, &Limb::cost);
}

/// Returns a region that starts at the limb's sample and frees its dimensions; the others are fixed
/// at `best`.
SearchRegion region_of(const Limb& limb, const SearchRegion& region, const Eigen::VectorXd& best,
                       double spread) {
  SearchRegion own = region;
  own.start = own.lower = own.upper = best;
  own.spread *= spread;
  for (const int d : *limb.dimensions) {
    own.start[d] = limb.point[d];
    own.lower[d] = region.lower[d];
    own.upper[d] = region.upper[d];
  }
  return own;
}

/// Returns a point with a limb where it was found.
Eigen::VectorXd with_limb(Eigen::VectorXd point, const Limb& limb) {
  for (const int d : *limb.dimensions) point[d] = limb.point[d];
  return point;
}

}  // namespace

OptimizerResult LimbSearch::minimize(CostFunction& cost, const SearchRegion& region,
                                     const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  const Deadline deadline(budget.seconds);
  std::vector<Limb> limbs = limbs_of(region);
  const auto count = static_cast<std::int64_t>(limbs.size());
  const std::int64_t samples =
      count == 0 ? 0 : std::min<std::int64_t>(params_.samples, (budget.evaluations - 1) / count);
  const Eigen::MatrixXd points = sampled(region, limbs, samples, seed);
  Eigen::VectorXd costs(points.cols());
  cost.evaluate(points, costs);
  OptimizerResult best{region.start, costs[0], points.cols()};
  if (samples == 0) return best;
  const double least = std::isfinite(best.cost) ? params_.gain * std::abs(best.cost) : 0;
  const double enough = best.cost - least;

  take_best(limbs, points, costs);
  // Each search may spend its part less one evaluation, in which limbs are joined.
  const std::int64_t evaluations = (budget.evaluations - best.evaluations) / count - 1;
  if (evaluations > 0 && !deadline.passed()) {
    std::vector<SearchRegion> regions;
    for (const Limb& limb : limbs) {
      regions.push_back(region_of(limb, region, region.start, params_.spread));
    }
    const std::vector<OptimizerResult> found = optimizer_->minimize_each(
        cost, regions, {evaluations, deadline.left(), budget.usual_cost}, seed);
    for (std::size_t k = 0; k < limbs.size(); ++k) {
      best.evaluations += found[k].evaluations;
      limbs[k].point = found[k].point;
      limbs[k].cost = found[k].cost;
    }
  }
  std::erase_if(limbs, [&](const Limb& limb) { return !(limb.cost < enough); });
  std::ranges::stable_sort(limbs, {}, &Limb::cost);
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    const Eigen::VectorXd point = with_limb(best.point, limbs[k]);
    Eigen::VectorXd its_cost = Eigen::VectorXd::Constant(1, limbs[k].cost);
    if (k > 0) {
      if (best.evaluations >= budget.evaluations) break;
      cost.evaluate(point, its_cost);
      ++best.evaluations;
    }
    if (!(its_cost[0] < best.cost)) continue;
    best.point = point;
    best.cost = its_cost[0];
  }
  return best;
}

}  // namespace hypotrack
