#include "hypotrack/search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const auto kFlat = [](const Eigen::VectorXd&) { return 0.0; };

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

TEST(Search, ADeadlineOfZeroHasPassedAndAnInfiniteOneNeverDoes) {
  EXPECT_TRUE(Deadline(0).passed());
  EXPECT_FALSE(Deadline(std::numeric_limits<double>::infinity()).passed());
}

}  // namespace
}  // namespace hypotrack
