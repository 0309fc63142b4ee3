#include "limb_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "hypotrack/plugin/search.hpp"
#include "search_problems.hpp"
#include "staying_optimizer.hpp"

namespace hypotrack {
namespace {

constexpr int kDimension = 27;  // a pose of 7 and five limbs of 4

struct Search {
  explicit Search(test::Problem problem, const LimbSearchParams& params = {},
                  std::int64_t budget = 200,
                  SearchRegion around = test::tracking_region(kDimension))
      : region(std::move(around)), cost(kDimension, std::move(problem)) {
    LimbSearch search(params, std::make_unique<test::StayingOptimizer>(regions));
    result = search.minimize(cost, region, {budget}, 1);
  }

  SearchRegion region;
  test::RecordingCost cost;
  std::vector<SearchRegion> regions;  ///< of the searches of limbs
  OptimizerResult result;
};

/// What the third limb costs where it is `at`, in dimension 15 of 15 to 18; nothing else matters.
test::Problem third_limb_at(double at) {
  return test::Problem(
      [at](const Eigen::VectorXd& point) { return 100 + std::abs(point[15] - at); });
}

/// How many groups of the region differ between two points.
int groups_moved(const SearchRegion& region, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  int moved = 0;
  for (const SearchGroup& group : region.groups) {
    for (const int d : group.dimensions) {
      if (a[d] == b[d]) continue;
      ++moved;
      break;
    }
  }
  return moved;
}

TEST(LimbSearch, SamplesEveryLimbAllOverItsBoundsWhileTheRestStays) {
  LimbSearchParams params;
  params.samples = 30;
  const Search search(third_limb_at(0), params, 151);
  ASSERT_EQ(search.cost.points.size(), 151u);
  EXPECT_EQ(search.cost.points[0], search.region.start);
  std::vector<double> lowest(kDimension, 1e9), highest(kDimension, -1e9);
  for (std::size_t i = 1; i < search.cost.points.size(); ++i) {
    const Eigen::VectorXd& point = search.cost.points[i];
    EXPECT_EQ(groups_moved(search.region, point, search.region.start), 1);
    EXPECT_EQ(point.head(7), search.region.start.head(7));
    for (int d = 7; d < kDimension; ++d) {
      if (point[d] == search.region.start[d]) continue;
      const auto at = static_cast<std::size_t>(d);
      lowest[at] = std::min(lowest[at], point[d]);
      highest[at] = std::max(highest[at], point[d]);
    }
  }
  for (std::size_t d = 7; d < kDimension; ++d) {
    EXPECT_LT(lowest[d], 0.1) << d;  // of -0.3 to 1.6
    EXPECT_GT(highest[d], 1.2) << d;
  }
}

TEST(LimbSearch, SearchesEachLimbFromItsBestSampleWithTheOthersHeld) {
  const Search search(third_limb_at(1.5));
  ASSERT_EQ(search.regions.size(), 5u);
  const SearchRegion& first = search.regions.front();
  std::size_t best = 0;
  for (std::size_t i = 0; i < search.cost.costs.size(); ++i) {
    if (search.cost.costs[i] < search.cost.costs[best]) best = i;
  }
  EXPECT_EQ(first.start, search.cost.points[best]) << "the limb that gains most comes first";
  for (const SearchRegion& region : search.regions) {
    EXPECT_EQ(groups_moved(region, region.lower, region.upper), 1);
    EXPECT_EQ(groups_moved(region, region.start, search.region.start), 1);
    EXPECT_EQ(region.spread, 2 * search.region.spread);
  }
  EXPECT_EQ(search.result.point, first.start);
}

TEST(LimbSearch, JoinsTheLimbsThatGain) {
  const Search search(test::Problem([](const Eigen::VectorXd& p) {
    // The fourth limb gains where it is alone, and loses beside the third.
    const bool third = p[15] < 0.5, fourth = p[19] < 0.5;
    return 100 + std::abs(p[7] - 1.5) + (third ? 0 : 3) + (fourth ? 0 : 2) +
           (third && fourth ? 5 : 0);
  }));
  const Eigen::VectorXd& start = search.region.start;
  ASSERT_GT(start[15], 0.5);
  ASSERT_GT(start[19], 0.5);
  EXPECT_LT(search.result.point[15], 0.5);
  EXPECT_EQ(search.result.point.tail(8), start.tail(8));
  EXPECT_LT(std::abs(search.result.point[7] - 1.5), std::abs(start[7] - 1.5));
  EXPECT_LE(search.result.evaluations, 200);
}

TEST(LimbSearch, ALimbStaysUnlessMovingItGainsEnough) {
  LimbSearchParams params;
  params.gain = 0.02;  // 2 of a little over 100
  const Search little(third_limb_at(test::tracking_region(kDimension).start[15] - 0.3), params);
  EXPECT_EQ(little.result.point, little.region.start);
  EXPECT_EQ(little.result.cost, little.cost.costs[0]);
  const Search much(
      test::Problem([](const Eigen::VectorXd& p) { return 100 + 10 * std::abs(p[15]); }), params);
  EXPECT_NE(much.result.point, much.region.start);
  EXPECT_EQ(groups_moved(much.region, much.result.point, much.region.start), 1);
}

TEST(LimbSearch, LeavesAnInfeasibleStart) {
  LimbSearchParams params;
  params.gain = 0.02;
  const Search search(test::Problem([](const Eigen::VectorXd& p) {
                        return p[15] < 0.8 ? p[15] + 1 : std::numeric_limits<double>::infinity();
                      }),
                      params);
  EXPECT_GT(search.region.start[15], 0.8);
  EXPECT_LT(search.result.point[15], 0.8);
}

TEST(LimbSearch, SpendsNoMoreThanItMayAndStaysWhereThereAreNoLimbs) {
  for (const std::int64_t budget : {1, 5, 6, 80, 83, 200}) {
    const Search search(third_limb_at(1.5), {}, budget);
    EXPECT_LE(search.result.evaluations, budget);
    EXPECT_EQ(search.result.evaluations, static_cast<std::int64_t>(search.cost.costs.size()));
  }
  SearchRegion no_limbs = test::tracking_region(kDimension);
  no_limbs.groups.clear();
  const Search search(third_limb_at(1.5), {}, 200, no_limbs);
  EXPECT_EQ(search.result.evaluations, 1);
  EXPECT_EQ(search.result.point, no_limbs.start);
}

}  // namespace
}  // namespace hypotrack
