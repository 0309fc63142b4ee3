#include "output/metrics/frame_outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hypotrack {
namespace {

constexpr double kUnknownNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoAnswer = std::numeric_limits<double>::infinity();

TEST(FrameOutcome, ASmallErrorIsFoundWhateverItCosts) {
  EXPECT_EQ(outcome_of(19.9, -0.5, -0.9), FrameOutcome::found);
  EXPECT_EQ(outcome_of(19.9, -0.9, -0.5), FrameOutcome::found);
}

TEST(FrameOutcome, AWrongPoseAboveACheaperTruthIsTheSearchsFault) {
  EXPECT_EQ(outcome_of(20, -0.5, -0.9), FrameOutcome::search_failed);
  EXPECT_EQ(outcome_of(60, kNoAnswer, -0.9), FrameOutcome::search_failed);
  EXPECT_EQ(outcome_of(60, kNoAnswer, kUnknownNumber), FrameOutcome::search_failed);
}

TEST(FrameOutcome, AWrongPoseAsCheapAsTheTruthIsTheObjectivesFault) {
  EXPECT_EQ(outcome_of(60, -0.9, -0.5), FrameOutcome::objective_failed);
  EXPECT_EQ(outcome_of(60, -0.9, -0.9), FrameOutcome::objective_failed);
  EXPECT_EQ(outcome_of(60, -0.9, kNoAnswer), FrameOutcome::objective_failed);
}

TEST(FrameOutcome, IsUnknownWithoutAnErrorOrACost) {
  EXPECT_EQ(outcome_of(kUnknownNumber, -0.9, -0.5), FrameOutcome::unknown);
  EXPECT_EQ(outcome_of(60, kUnknownNumber, -0.5), FrameOutcome::unknown);
  EXPECT_EQ(outcome_of(60, -0.9, kUnknownNumber), FrameOutcome::unknown);
  EXPECT_EQ(outcome_of(6, -0.9, kUnknownNumber), FrameOutcome::unknown);
}

TEST(FrameOutcome, SharesAreOfTheFramesWithAKnownOne) {
  OutcomeCounts counts;
  EXPECT_TRUE(std::isnan(counts.share(FrameOutcome::found)));
  for (const FrameOutcome outcome :
       {FrameOutcome::found, FrameOutcome::found, FrameOutcome::search_failed,
        FrameOutcome::unknown, FrameOutcome::objective_failed})
    counts.add(outcome);
  EXPECT_EQ(counts.share(FrameOutcome::found), 0.5);
  EXPECT_EQ(counts.share(FrameOutcome::search_failed), 0.25);
  EXPECT_EQ(counts.share(FrameOutcome::objective_failed), 0.25);
}

}  // namespace
}  // namespace hypotrack
