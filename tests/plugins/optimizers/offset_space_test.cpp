#include "hypotrack/plugin/offset_space.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hypotrack {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The second dimension has no room.
SearchRegion region() {
  return {Eigen::Vector3d(1, 5, 0), Eigen::Vector3d(-kInfinity, 5, -0.5),
          Eigen::Vector3d(kInfinity, 5, 4), Eigen::Vector3d(2, 1, 0.5)};
}

TEST(OffsetSpace, HasTheFreeDimensionsInSpreadsFromTheStart) {
  const SearchRegion around = region();
  const OffsetSpace space(around);
  EXPECT_EQ(space.dimension(), 2);
  EXPECT_EQ(space.offsets(Eigen::Vector3d(3, 5, 1)), Eigen::Vector2d(1, 2));
  EXPECT_EQ(space.point(std::vector{1.0, 2.0}), Eigen::Vector3d(3, 5, 1));
  EXPECT_EQ(space.point(std::vector{0.0, -7.0}), Eigen::Vector3d(1, 5, -0.5)) << "within bounds";
}

TEST(OffsetSpace, ABoxLimitsWhatTheBoundsLeaveOpen) {
  const SearchRegion around = region();
  const OffsetSpace space(around);
  EXPECT_EQ(space.lower(3), Eigen::Vector2d(-3, -1));
  EXPECT_EQ(space.upper(3), Eigen::Vector2d(3, 3));
  EXPECT_EQ(space.upper(kInfinity), Eigen::Vector2d(kInfinity, 8));
}

TEST(FiniteCosts, AreWorseThanAllThatWasSeenWhereTheCostIsInfinite) {
  FiniteCosts costs;
  EXPECT_EQ(costs.of(kInfinity), FiniteCosts::kUnknown);
  EXPECT_EQ(costs.of(-5), -5);
  EXPECT_EQ(costs.of(-3), -3);
  const double penalty = costs.of(kInfinity);
  EXPECT_GT(penalty, -3);
  EXPECT_LT(penalty, 10) << "in the scale of what was seen";
  EXPECT_EQ(costs.of(100), 100);
  EXPECT_GT(costs.of(kInfinity), 100);
}

}  // namespace
}  // namespace hypotrack
