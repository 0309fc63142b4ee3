#include "hypotrack/plugin/search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "hypotrack/plugin/linearization.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const auto kFlat = [](const Eigen::VectorXd&) { return 0.0; };

TEST(Linearizer, RefusesACostWithoutResiduals) {
  test::RecordingCost cost(8, kFlat);
  cost.has_residuals = false;
  const SearchRegion region = test::tracking_region(8);
  BestSoFar best;
  EXPECT_THROW(Linearizer(cost, region, {}, best), ConfigError);
}

TEST(Search, ARegionThatBreaksItsContractIsNamed) {
  test::RecordingCost cost(8, kFlat);
  const SearchRegion good = test::tracking_region(8);
  EXPECT_NO_THROW(check_search(cost, good, {1}));

  SearchRegion bad = good;
  bad.start[7] = 2;
  EXPECT_THAT([&] { check_search(cost, bad, {1}); },
              ThrowsMessage<Error>(HasSubstr("start[7] is 2.000000, expected within its bounds")));
  bad = good;
  bad.start[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { check_search(cost, bad, {1}); }, ThrowsMessage<Error>(HasSubstr("start[0]")));
  bad = good;
  bad.spread[2] = 0;
  EXPECT_THAT([&] { check_search(cost, bad, {1}); },
              ThrowsMessage<Error>(HasSubstr("spread[2] is 0.000000, expected positive")));
  bad = good;
  bad.upper.conservativeResize(7);
  EXPECT_THAT([&] { check_search(cost, bad, {1}); },
              ThrowsMessage<Error>(HasSubstr("must have the cost's dimension, 8")));
}

TEST(Search, ABudgetWithoutEvaluationsIsAConfigError) {
  test::RecordingCost cost(8, kFlat);
  EXPECT_THAT([&] { check_search(cost, test::tracking_region(8), {0}); },
              ThrowsMessage<ConfigError>(HasSubstr("0 evaluations, expected at least 1")));
}

TEST(Search, EveryDimensionIsInOneGroupOrThereAreNone) {
  SearchRegion region = test::tracking_region(3);
  region.groups.clear();
  EXPECT_TRUE(group_of_dimension(region).empty());
  region.groups = {{SearchGroup::Kind::pose, {0, 2}}, {SearchGroup::Kind::limb, {1}}};
  EXPECT_EQ(group_of_dimension(region), (std::vector<int>{0, 1, 0}));

  region.groups[1].dimensions = {1, 2};
  EXPECT_THAT(
      [&] { group_of_dimension(region); },
      ThrowsMessage<Error>(HasSubstr("groups[1] has dimension 2, expected each of 0 to 2")));
  region.groups[1].dimensions = {3};
  EXPECT_THAT([&] { group_of_dimension(region); },
              ThrowsMessage<Error>(HasSubstr("groups[1] has dimension 3")));
  region.groups.pop_back();
  EXPECT_THAT([&] { group_of_dimension(region); },
              ThrowsMessage<Error>(HasSubstr("dimension 1 is in no group")));
}

TEST(Search, TheEarlierOfEqualPointsStaysTheBest) {
  BestSoFar best;
  const Eigen::MatrixXd points = Eigen::MatrixXd{{1, 2, 3}};
  best.update(points, Eigen::Vector3d(5, 5, 6));
  EXPECT_EQ(best.result().point[0], 1);
  best.update(points, Eigen::Vector3d(7, 5, 5));
  EXPECT_EQ(best.result().point[0], 1);
  best.update(points, Eigen::Vector3d(7, 6, 4));
  EXPECT_EQ(best.result().point[0], 3);
  EXPECT_EQ(best.result().cost, 4);
  EXPECT_EQ(best.result().evaluations, 9);
}

TEST(Search, PartsOfASearchHaveSeedsOfTheirOwn) {
  std::set<std::uint64_t> seeds;
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{1} << 40}) {
    for (std::uint32_t part = 0; part < 10; ++part) seeds.insert(seed_of_part(seed, part));
  }
  EXPECT_EQ(seeds.size(), 20u);
}

TEST(Search, ADeadlineOfZeroHasPassedAndAnInfiniteOneNeverDoes) {
  EXPECT_TRUE(Deadline(0).passed());
  EXPECT_FALSE(Deadline(std::numeric_limits<double>::infinity()).passed());
}

}  // namespace
}  // namespace hypotrack
