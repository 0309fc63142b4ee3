#include "track/status.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hypotrack {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr auto kNoMask = OnForeground::unknown;

StatusMonitor experienced_monitor(const StatusSettings& settings = {}) {
  StatusMonitor monitor(settings);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(monitor.judge(-100 + i % 3, 1.0, kUnknown, kNoMask), Status::tracked);
  return monitor;
}

TEST(Status, AnUsualCostIsTracked) {
  EXPECT_EQ(experienced_monitor().judge(-98, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, AnOutlierOfTheCostIsUncertain) {
  EXPECT_EQ(experienced_monitor().judge(-60, 1.0, kUnknown, kNoMask), Status::uncertain);
}

TEST(Status, ABetterCostThanEverIsTracked) {
  EXPECT_EQ(experienced_monitor().judge(-500, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, WhatIsUsualLiesBetweenUsualCostsAndOutliers) {
  EXPECT_GT(experienced_monitor().usual_cost(), -98);
  EXPECT_LT(experienced_monitor().usual_cost(), -60);
  EXPECT_EQ(StatusMonitor({}).usual_cost(), -std::numeric_limits<double>::infinity());
}

TEST(Status, UncertaintyThatLastsIsLost) {
  StatusSettings settings;
  settings.patience = 4;
  StatusMonitor monitor = experienced_monitor(settings);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(monitor.judge(0, 1.0, kUnknown, kNoMask), Status::uncertain);
  EXPECT_EQ(monitor.judge(0, 1.0, kUnknown, kNoMask), Status::lost);
  EXPECT_EQ(monitor.judge(-99, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, ACostThatStaysBecomesWhatIsExpected) {
  StatusMonitor monitor = experienced_monitor();
  int uncertain = 0;
  while (monitor.judge(-60, 1.0, kUnknown, kNoMask) != Status::tracked) ASSERT_LT(++uncertain, 40);
  EXPECT_GT(uncertain, 3);
  EXPECT_EQ(monitor.judge(-60, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, OutOfViewIsLostAndHalfOutIsUncertain) {
  EXPECT_EQ(experienced_monitor().judge(-99, 0.1, kUnknown, kNoMask), Status::lost);
  EXPECT_EQ(experienced_monitor().judge(-99, 0.5, kUnknown, kNoMask), Status::uncertain);
}

TEST(Status, BesideTheForegroundOfAllMasksIsLostAndOfSomeUncertain) {
  EXPECT_EQ(experienced_monitor().judge(-99, 1.0, kUnknown, OnForeground::nowhere), Status::lost);
  EXPECT_EQ(experienced_monitor().judge(-99, 1.0, kUnknown, OnForeground::in_parts),
            Status::uncertain);
  EXPECT_EQ(experienced_monitor().judge(-99, 1.0, kUnknown, OnForeground::yes), Status::tracked);
}

TEST(Status, AnInfeasibleSolutionIsLost) {
  EXPECT_EQ(
      experienced_monitor().judge(std::numeric_limits<double>::infinity(), 1.0, kUnknown, kNoMask),
      Status::lost);
}

TEST(Status, ALargeSigmaIsUncertainHoweverLongItLastsAndALargerOneLost) {
  StatusSettings settings;
  settings.uncertain_sigma = 0.008;
  settings.lost_sigma = 0.050;
  StatusMonitor monitor = experienced_monitor(settings);
  EXPECT_EQ(monitor.judge(-99, 1.0, 0.007, kNoMask), Status::tracked);
  for (int i = 0; i < 3 * settings.patience; ++i)
    EXPECT_EQ(monitor.judge(-99, 1.0, 0.009, kNoMask), Status::uncertain);
  EXPECT_EQ(monitor.judge(-99, 1.0, 0.051, kNoMask), Status::lost);
  EXPECT_EQ(monitor.judge(-99, 1.0, std::numeric_limits<double>::infinity(), kNoMask),
            Status::lost);
  EXPECT_EQ(monitor.judge(-99, 1.0, 0.007, kNoMask), Status::tracked);
}

TEST(Status, TheFirstFramesHaveNothingToCompareWith) {
  StatusMonitor monitor({});
  EXPECT_EQ(monitor.judge(-1, 1.0, kUnknown, kNoMask), Status::tracked);
  EXPECT_EQ(monitor.judge(1000, 1.0, kUnknown, kNoMask), Status::tracked);
}

}  // namespace
}  // namespace hypotrack
