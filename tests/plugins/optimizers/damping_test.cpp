#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {
namespace {

constexpr DampingSchedule kSchedule = {
    .first = 1, .least = 0.1, .most = 100, .accepted = 0.5, .rejected = 4};

TEST(Damping, FallsAfterAcceptedStepsAndRisesAfterRejectedOnes) {
  Damping damping(kSchedule);
  EXPECT_EQ(damping.value(), 1);
  damping.accept();
  EXPECT_EQ(damping.value(), 0.5);
  damping.reject();
  EXPECT_EQ(damping.value(), 2);
}

TEST(Damping, ContinuesFromTheTrialThatWasTaken) {
  Damping damping(kSchedule);
  damping.accept(8);
  EXPECT_EQ(damping.value(), 4);
  damping.reject(2);
  EXPECT_EQ(damping.value(), 8);
}

TEST(Damping, StaysWithinItsLimits) {
  Damping damping(kSchedule);
  for (int i = 0; i < 10; ++i) damping.accept();
  EXPECT_EQ(damping.value(), kSchedule.least);
  for (int i = 0; i < 10; ++i) damping.reject();
  EXPECT_EQ(damping.value(), kSchedule.most);
  damping.scale(1e9);
  EXPECT_EQ(damping.value(), kSchedule.most);
  damping.scale(1e-9);
  EXPECT_EQ(damping.value(), kSchedule.least);
  damping.accept(1e9);
  EXPECT_EQ(damping.value(), kSchedule.most);
}

TEST(Damping, IsExhaustedWhenARejectionWouldExceedTheLimit) {
  Damping damping(kSchedule);
  for (int i = 0; i < 3; ++i) damping.reject();
  EXPECT_EQ(damping.value(), 64);
  EXPECT_FALSE(damping.exhausted());
  damping.reject();
  EXPECT_TRUE(damping.exhausted());
  damping.accept();
  EXPECT_FALSE(damping.exhausted());
}

TEST(Damping, IsNotExhaustedAtTheLimit) {
  Damping damping(kSchedule);
  damping.reject(25);
  EXPECT_EQ(damping.value(), kSchedule.most);
  EXPECT_FALSE(damping.exhausted());
}

TEST(Damping, ReturnsToItsFirstValueOnlyFromAbove) {
  Damping damping(kSchedule);
  damping.accept();
  damping.lower_to_first();
  EXPECT_EQ(damping.value(), 0.5);
  damping.reject();
  damping.lower_to_first();
  EXPECT_EQ(damping.value(), 1);
}

TEST(Damping, ShortensStepsAndHoldsUnknownsWithoutCurvature) {
  Eigen::MatrixXd normal = Eigen::Vector2d(4, 0).asDiagonal();
  damp(normal, 0.5, 2);
  EXPECT_EQ(normal, Eigen::MatrixXd(Eigen::Vector2d(7, 1).asDiagonal()));
  const Eigen::VectorXd step = normal.ldlt().solve(Eigen::Vector2d(4, 0));
  EXPECT_LT(step[0], 1);
  EXPECT_EQ(step[1], 0);
}

TEST(BlockedByBound, IsTrueWhereDescentWouldLeave) {
  EXPECT_TRUE(blocked_by_bound(0, 0, 1, 2));
  EXPECT_FALSE(blocked_by_bound(0, 0, 1, -2));
  EXPECT_TRUE(blocked_by_bound(1, 0, 1, -2));
  EXPECT_FALSE(blocked_by_bound(1, 0, 1, 2));
  EXPECT_FALSE(blocked_by_bound(0.5, 0, 1, 2));
  EXPECT_FALSE(blocked_by_bound(0, 0, 1, 0));
}

}  // namespace
}  // namespace hypotrack
