#include "output/run/worst_frames.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <utility>
#include <vector>

namespace hypotrack {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The frames that are remembered of a sequence of frame numbers and errors.
std::vector<int> remembered(int count, const std::vector<std::pair<int, double>>& errors) {
  WorstFrames worst(count);
  for (const auto& [frame, error] : errors)
    if (worst.wants(frame, error))
      worst.offer({.frame = frame,
                   .error = error,
                   .status = "",
                   .picture = {},
                   .solution = {},
                   .truth = {}});
  std::vector<int> frames;
  for (const WorstFrame& kept : worst.frames()) frames.push_back(kept.frame);
  return frames;
}

TEST(WorstFrames, TheLargestErrorsStay) {
  EXPECT_THAT(remembered(2, {{0, 0.01}, {20, 0.03}, {40, 0.02}, {60, 0.005}}), ElementsAre(20, 40));
}

TEST(WorstFrames, OfNeighboursOnlyTheWorstStays) {
  EXPECT_THAT(remembered(3, {{0, 0.01}, {5, 0.02}, {9, 0.03}, {12, 0.025}}), ElementsAre(9));
  EXPECT_THAT(remembered(3, {{0, 0.01}, {10, 0.02}}), ElementsAre(10, 0));
}

TEST(WorstFrames, AnErrorThatKeepsGrowingTakesOnePlaceForEveryTenFrames) {
  std::vector<std::pair<int, double>> growing;
  for (int frame = 0; frame < 200; ++frame) growing.emplace_back(frame, 0.001 * frame);
  EXPECT_THAT(remembered(3, growing), ElementsAre(199, 189, 179));
}

TEST(WorstFrames, ThoseNearAWorseOneMakeRoomForOthers) {
  // 39 and 50 are near 45; only then come 20 and 70.
  EXPECT_THAT(remembered(3, {{20, 0.02}, {39, 0.08}, {45, 0.09}, {50, 0.07}, {70, 0.01}}),
              ElementsAre(45, 20, 70));
}

TEST(WorstFrames, FramesWithoutErrorAndACountOfZeroAreNotWanted) {
  EXPECT_THAT(remembered(3, {{0, std::numeric_limits<double>::quiet_NaN()}}), IsEmpty());
  EXPECT_THAT(remembered(0, {{0, 1.0}}), IsEmpty());
}

}  // namespace
}  // namespace hypotrack
