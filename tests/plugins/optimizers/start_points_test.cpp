#include "hypotrack/plugin/start_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "search_problems.hpp"

namespace hypotrack {
namespace {

constexpr int kMany = 3000;

/// Offsets of the points in spreads, without the first one.
Eigen::MatrixXd offsets(const SearchRegion& region, const StartDistribution& starts,
                        int count = kMany) {
  const Eigen::MatrixXd points = StartPoints(region, starts, 3).points(0, count);
  return ((points.colwise() - region.start).array().colwise() / region.spread.array())
      .matrix()
      .rightCols(count - 1);
}

/// A pose of two dimensions and three limbs of two, far from every bound.
SearchRegion wide_region() {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(8);
  SearchRegion region{0 * one, -100 * one, 100 * one, 2 * one};
  for (int g = 0; g < 4; ++g) {
    const auto kind = g == 0 ? SearchGroup::Kind::pose : SearchGroup::Kind::limb;
    region.groups.push_back({kind, {2 * g, 2 * g + 1}});
  }
  return region;
}

TEST(StartPoints, TheFirstIsTheStartAndTheOthersAreNormalAboutIt) {
  const SearchRegion region = wide_region();
  EXPECT_EQ(StartPoints(region, {}, 3).points(0, 5).col(0), region.start);
  const Eigen::MatrixXd u = offsets(region, {});
  EXPECT_NEAR(u.mean(), 0, 0.02);
  EXPECT_NEAR(std::sqrt(u.array().square().mean()), 0.5, 0.02);
}

TEST(StartPoints, EachIsAFunctionOfItsNumber) {
  const SearchRegion region = test::tracking_region(27);
  StartDistribution starts;
  starts.group_share = 0.3;
  const StartPoints points(region, starts, 3);
  EXPECT_EQ(points.points(4, 3), points.points(0, 7).rightCols(3));
}

TEST(StartPoints, TheyStayWithinTheBounds) {
  const SearchRegion region = test::tracking_region(27);
  StartDistribution starts;
  starts.sigma = 10;
  const Eigen::MatrixXd points = StartPoints(region, starts, 3).points(0, 100);
  for (const auto& point : points.colwise()) {
    EXPECT_TRUE((point.array() >= region.lower.array()).all());
    EXPECT_TRUE((point.array() <= region.upper.array()).all());
  }
}

TEST(StartPoints, AShareOfTheGroupsMovesByAllOfSigma) {
  const SearchRegion region = wide_region();
  StartDistribution starts;
  starts.group_share = 0.3;
  starts.group_rest = 0;
  const Eigen::MatrixXd u = offsets(region, starts);
  int moved = 0;
  double squares = 0;
  for (Eigen::Index n = 0; n < u.cols(); ++n) {
    for (const SearchGroup& group : region.groups) {
      const double first = u(group.dimensions[0], n), second = u(group.dimensions[1], n);
      EXPECT_EQ(first == 0, second == 0) << "a group moves as a whole or not at all";
      moved += first != 0;
      squares += first * first;
    }
  }
  EXPECT_NEAR(moved / (4.0 * static_cast<double>(u.cols())), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(squares / moved), 0.5, 0.02);
}

TEST(StartPoints, TheOtherGroupsMoveByTheRestOfIt) {
  StartDistribution starts;
  starts.group_share = 0;
  starts.group_rest = 0.1;
  EXPECT_NEAR(std::sqrt(offsets(wide_region(), starts).array().square().mean()), 0.05, 0.002);
}

TEST(StartPoints, WithoutGroupsEveryDimensionIsOne) {
  SearchRegion region = wide_region();
  region.groups.clear();
  StartDistribution starts;
  starts.group_share = 0.3;
  starts.group_rest = 0;
  const Eigen::MatrixXd u = offsets(region, starts);
  int moved = 0, pairs = 0;
  for (Eigen::Index n = 0; n < u.cols(); ++n) {
    moved += static_cast<int>((u.col(n).array() != 0).count());
    pairs += u(0, n) != 0 && u(1, n) != 0;
  }
  EXPECT_NEAR(moved / (8.0 * static_cast<double>(u.cols())), 0.3, 0.02);
  EXPECT_NEAR(pairs / static_cast<double>(u.cols()), 0.09, 0.02)
      << "two dimensions are independent";
}

}  // namespace
}  // namespace hypotrack
