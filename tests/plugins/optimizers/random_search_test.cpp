#include "random_search/random_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;

TEST(RandomSearch, SamplesInWholeBatches) {
  RandomSearchParams params;
  params.batch = 100;
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  RandomSearch(params).minimize(cost, region, {250}, 1);
  EXPECT_THAT(cost.batches, ElementsAre(100, 100, 50));
}

TEST(RandomSearch, TheBatchSizeDoesNotChangeTheSamples) {
  RandomSearchParams params;
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost large(27, test::sphere(region, region.start));
  RandomSearch(params).minimize(large, region, {64}, 1);
  params.batch = 5;
  test::RecordingCost small(27, test::sphere(region, region.start));
  RandomSearch(params).minimize(small, region, {64}, 1);
  EXPECT_EQ(large.points, small.points);
}

TEST(RandomSearch, SamplesHaveTheRegionsSpreadTimesSigma) {
  RandomSearchParams params;
  params.start.sigma = 0.25;
  const SearchRegion region = test::tracking_region(7);
  test::RecordingCost cost(7, [](const Eigen::VectorXd&) { return 0.0; });
  RandomSearch(params).minimize(cost, region, {4000}, 2);
  double squares = 0;
  for (const auto& point : cost.points) squares += std::pow(point[0] - region.start[0], 2);
  EXPECT_NEAR(std::sqrt(squares / 4000), 0.25 * 0.04, 0.0005);
}

TEST(RandomSearch, StopsBetweenBatchesWhenTheTimeIsUp) {
  const SearchRegion region = test::tracking_region(27);
  test::RecordingCost cost(27, test::sphere(region, region.start));
  EXPECT_EQ(RandomSearch({}).minimize(cost, region, {100000, 0.0}, 1).evaluations, 256);
}

}  // namespace
}  // namespace hypotrack
