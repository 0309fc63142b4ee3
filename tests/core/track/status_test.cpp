#include "track/status.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace hypotrack {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr auto kNoMask = ForegroundOverlap::unknown;

/// The status of an answer of which pictures say nothing.
Status judge(StatusMonitor&& monitor, double cost, double visible, double sigma,
             ForegroundOverlap foreground_overlap) {
  return monitor.judge({.cost = cost,
                        .probability = kUnknown,
                        .visible = visible,
                        .sigma = sigma,
                        .foreground_overlap = foreground_overlap});
}
Status judge(StatusMonitor& monitor, double cost, double visible, double sigma,
             ForegroundOverlap foreground_overlap) {
  return judge(std::move(monitor), cost, visible, sigma, foreground_overlap);
}

/// The status of an answer by how likely pictures make it.
Status judge_by_pictures(StatusMonitor& monitor, double probability, double cost = -100) {
  return monitor.judge({.cost = cost, .probability = probability, .visible = 1, .sigma = kUnknown});
}

StatusMonitor experienced_monitor(const StatusSettings& settings = {}) {
  StatusMonitor monitor(settings);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(judge(monitor, -100 + i % 3, 1.0, kUnknown, kNoMask), Status::tracked);
  return monitor;
}

TEST(Status, AnUsualCostIsTracked) {
  EXPECT_EQ(judge(experienced_monitor(), -98, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, AnOutlierOfTheCostIsUncertain) {
  EXPECT_EQ(judge(experienced_monitor(), -60, 1.0, kUnknown, kNoMask), Status::uncertain);
}

TEST(Status, ABetterCostThanEverIsTracked) {
  EXPECT_EQ(judge(experienced_monitor(), -500, 1.0, kUnknown, kNoMask), Status::tracked);
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
    EXPECT_EQ(judge(monitor, 0, 1.0, kUnknown, kNoMask), Status::uncertain);
  EXPECT_EQ(judge(monitor, 0, 1.0, kUnknown, kNoMask), Status::lost);
  EXPECT_EQ(judge(monitor, -99, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, ACostThatStaysBecomesWhatIsExpected) {
  StatusMonitor monitor = experienced_monitor();
  int uncertain = 0;
  while (judge(monitor, -60, 1.0, kUnknown, kNoMask) != Status::tracked) ASSERT_LT(++uncertain, 40);
  EXPECT_GT(uncertain, 3);
  EXPECT_EQ(judge(monitor, -60, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, OutOfViewIsLostAndHalfOutIsUncertain) {
  EXPECT_EQ(judge(experienced_monitor(), -99, 0.1, kUnknown, kNoMask), Status::lost);
  EXPECT_EQ(judge(experienced_monitor(), -99, 0.5, kUnknown, kNoMask), Status::uncertain);
}

TEST(Status, BesideTheForegroundOfAllMasksIsLostAndOfSomeUncertain) {
  EXPECT_EQ(judge(experienced_monitor(), -99, 1.0, kUnknown, ForegroundOverlap::nowhere),
            Status::lost);
  EXPECT_EQ(judge(experienced_monitor(), -99, 1.0, kUnknown, ForegroundOverlap::in_parts),
            Status::uncertain);
  EXPECT_EQ(judge(experienced_monitor(), -99, 1.0, kUnknown, ForegroundOverlap::yes),
            Status::tracked);
}

TEST(Status, AnInfeasibleSolutionIsLost) {
  EXPECT_EQ(
      judge(experienced_monitor(), std::numeric_limits<double>::infinity(), 1.0, kUnknown, kNoMask),
      Status::lost);
}

TEST(Status, ALargeSigmaIsUncertainHoweverLongItLastsAndALargerOneLost) {
  StatusSettings settings;
  settings.uncertain_sigma = 0.008;
  settings.lost_sigma = 0.050;
  StatusMonitor monitor = experienced_monitor(settings);
  EXPECT_EQ(judge(monitor, -99, 1.0, 0.007, kNoMask), Status::tracked);
  for (int i = 0; i < 3 * settings.patience; ++i)
    EXPECT_EQ(judge(monitor, -99, 1.0, 0.009, kNoMask), Status::uncertain);
  EXPECT_EQ(judge(monitor, -99, 1.0, 0.051, kNoMask), Status::lost);
  EXPECT_EQ(judge(monitor, -99, 1.0, std::numeric_limits<double>::infinity(), kNoMask),
            Status::lost);
  EXPECT_EQ(judge(monitor, -99, 1.0, 0.007, kNoMask), Status::tracked);
}

TEST(Status, TheFirstFramesHaveNothingToCompareWith) {
  StatusMonitor monitor({});
  EXPECT_EQ(judge(monitor, -1, 1.0, kUnknown, kNoMask), Status::tracked);
  EXPECT_EQ(judge(monitor, 1000, 1.0, kUnknown, kNoMask), Status::tracked);
}

TEST(Status, FollowsWhatPicturesSayWhateverTheCost) {
  StatusMonitor monitor({});
  for (const double cost : {-100.0, 500.0, -800.0}) {
    EXPECT_EQ(judge_by_pictures(monitor, 0.95, cost), Status::tracked);
    EXPECT_EQ(judge_by_pictures(monitor, 0.3, cost), Status::uncertain);
    EXPECT_EQ(judge_by_pictures(monitor, 0.01, cost), Status::lost);
    EXPECT_EQ(judge_by_pictures(monitor, 0.95, cost), Status::tracked);
  }
}

TEST(Status, ADetectedAnswerIsUncertainHoweverUnlikely) {
  StatusMonitor monitor({});
  StatusMeasures measures{.cost = -100, .probability = 0.01, .visible = 1, .sigma = kUnknown};
  EXPECT_EQ(monitor.judge(measures), Status::lost);
  measures.detected = true;
  EXPECT_EQ(monitor.judge(measures), Status::uncertain);
  measures.visible = 0;
  EXPECT_EQ(monitor.judge(measures), Status::lost);
}

TEST(Status, AsksForMoreJustAfterALossThanBeforeIt) {
  StatusMonitor monitor({});
  EXPECT_EQ(judge_by_pictures(monitor, 0.6), Status::tracked);
  EXPECT_EQ(judge_by_pictures(monitor, 0.01), Status::lost);
  EXPECT_EQ(judge_by_pictures(monitor, 0.6), Status::uncertain);
  EXPECT_EQ(judge_by_pictures(monitor, 0.9), Status::tracked);
  EXPECT_EQ(judge_by_pictures(monitor, 0.6), Status::tracked);
}

TEST(Status, AnAnswerThatStaysLikelyIsTrackedAgain) {
  StatusMonitor monitor({});
  judge_by_pictures(monitor, 0.9);
  judge_by_pictures(monitor, 0.01);
  int uncertain = 0;
  while (judge_by_pictures(monitor, 0.6) != Status::tracked) ASSERT_LT(++uncertain, 10);
  EXPECT_GT(uncertain, 2);
}

TEST(Status, AConfirmedAnswerNeedsLess) {
  StatusMonitor monitor({});
  judge_by_pictures(monitor, 0.95);
  judge_by_pictures(monitor, 0.01);
  StatusMeasures measures{.cost = -100, .probability = 0.5, .visible = 1, .sigma = kUnknown};
  EXPECT_EQ(monitor.judge(measures), Status::uncertain);
  measures.confirmed = true;
  EXPECT_EQ(monitor.judge(measures), Status::tracked);
  measures.probability = 0.4;
  EXPECT_EQ(monitor.judge(measures), Status::uncertain);
}

TEST(Status, OnlyTrackedFramesSayWhatCostsAreUsual) {
  StatusMonitor monitor({});
  for (int i = 0; i < 20; ++i) judge_by_pictures(monitor, 0.95, -100 + i % 3);
  const double usual = monitor.usual_cost();
  for (int i = 0; i < 20; ++i) judge_by_pictures(monitor, 0.3, 500);
  EXPECT_EQ(monitor.usual_cost(), usual);
}

TEST(Status, IsAbsentWhereThePicturesShowNoSuchThing) {
  StatusMonitor monitor({});
  judge_by_pictures(monitor, 0.95);
  EXPECT_EQ(monitor.judge({.cost = std::numeric_limits<double>::infinity(), .in_view = false}),
            Status::absent);
}

TEST(Status, AGivenStartNeedsLessToBeTracked) {
  StatusMonitor monitor({});
  EXPECT_EQ(judge_by_pictures(monitor, 0.2), Status::uncertain);
  EXPECT_EQ(judge_by_pictures(monitor, 0.4), Status::tracked);
  EXPECT_EQ(judge_by_pictures(monitor, 0.4), Status::uncertain) << "from then on it needs more";
}

}  // namespace
}  // namespace hypotrack
