#include "multi_start.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"
#include "search_problems.hpp"
#include "staying_optimizer.hpp"

namespace hypotrack {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

MultiStartParams three_of_twenty() {
  MultiStartParams params;
  params.restarts = 3;
  params.candidates = 20;
  return params;
}

TEST(MultiStart, SearchesBeginAtTheBestCandidates) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, test::hidden_target(region, 5)));
  std::vector<SearchRegion> searches;
  MultiStart multi(three_of_twenty(), std::make_unique<test::StayingOptimizer>(searches));
  const OptimizerResult result = multi.minimize(cost, region, {50}, 1);

  EXPECT_EQ(result.evaluations, 50);
  EXPECT_THAT(cost.batches, ::testing::ElementsAre(20, 10, 10, 10));
  std::vector<std::size_t> order(20);
  for (std::size_t i = 0; i < 20; ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return cost.costs[i]; });
  ASSERT_EQ(searches.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(searches[k].start, cost.points[order[k]]) << k;
  EXPECT_EQ(result.point, searches[0].start);
}

TEST(MultiStart, ASmallBudgetSearchesFromAsManyStartsAsItCan) {
  const SearchRegion region = test::tracking_region(27);
  for (const std::int64_t budget : {1, 19, 20, 21, 22, 24}) {
    test::RecordingCost cost(27, test::sphere(region, test::hidden_target(region, 5)));
    std::vector<SearchRegion> searches;
    MultiStart multi(three_of_twenty(), std::make_unique<test::StayingOptimizer>(searches));
    const std::int64_t spent = multi.minimize(cost, region, {budget}, 1).evaluations;
    EXPECT_LE(spent, budget);
    EXPECT_GT(spent, budget - 3) << "every search has the same number";
    EXPECT_EQ(searches.size(),
              static_cast<std::size_t>(std::clamp<std::int64_t>(budget - 20, 0, 3)));
  }
}

TEST(MultiStart, MoreStartsThanCandidatesAreAConfigError) {
  MultiStartParams params = three_of_twenty();
  params.restarts = 21;
  EXPECT_THAT(
      [&] { MultiStart(params, nullptr, "scene.yaml:4:3"); },
      ThrowsMessage<ConfigError>(HasSubstr(
          "scene.yaml:4:3: multi_start: restarts is 21, expected at most the 20 candidates")));
}

}  // namespace
}  // namespace hypotrack
