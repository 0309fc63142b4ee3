// Views that repeat their pictures, with noise and without.

#include <gtest/gtest.h>

#include <algorithm>

#include "textured_pair.hpp"
#include "track/faults/picture_checks.hpp"

namespace hypotrack {
namespace {

using test::noisy;
using test::TexturedPair;

using FrozenViewsTest = test::TexturedPairChecks;

TEST_F(FrozenViewsTest, AFrozenViewWithFreshNoiseIsNamed) {
  const View still = pair_.frame(280).views[1];
  for (std::uint64_t i = 0; i < 4; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(260 + 5 * static_cast<int>(i)), 3, i)), FrameFault::none);
  for (std::uint64_t i = 4; i < 9; ++i) {
    Frame frame = pair_.frame(260 + 5 * static_cast<int>(i));
    frame.views[1] = still;
    const FrameFault fault = check(noisy(frame, 3, i));
    if (i < 6) continue;  // what moves has to differ from noise
    EXPECT_EQ(fault, FrameFault::frozen) << "frame " << i;
    EXPECT_EQ(last_.view, 1);
  }
  for (std::uint64_t i = 9; i < 12; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(260 + 5 * static_cast<int>(i)), 3, i)), FrameFault::none);
}

TEST_F(FrozenViewsTest, ViewsThatAllRepeatTheirNoiseAreNamed) {
  for (std::uint64_t i = 0; i < 3; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(280 + 5 * static_cast<int>(i)), 2, i)), FrameFault::none);
  const Frame frame = noisy(pair_.frame(295), 2, 3);
  for (int i = 0; i < 8; ++i) {
    const FrameFault fault = check(frame);
    EXPECT_EQ(fault, i < 3 ? FrameFault::none : FrameFault::frozen) << "frame " << i;
    EXPECT_EQ(last_.view, i < 3 ? 0 : -1);
  }
  EXPECT_EQ(check(noisy(pair_.frame(300), 2, 4)), FrameFault::none);
}

TEST_F(FrozenViewsTest, ViewsWithoutNoiseThatAllRepeatForLongAreNamed) {
  expect_sound(280, 5, 3);
  expect_sound(290, 0, 14);  // a pause, as in a video whose encoder removes noise
  EXPECT_EQ(check(pair_.frame(290)), FrameFault::frozen);
  EXPECT_EQ(last_.view, -1);
  expect_sound(295, 5, 3);
}

TEST_F(FrozenViewsTest, OnePictureThatIsShownForLongIsSound) { expect_sound(280, 0, 40); }

TEST_F(FrozenViewsTest, FramesThatArriveSeveralTimesAreSound) {
  for (int i = 0; i < 40; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(280 + i / 5), 2, static_cast<std::uint64_t>(i / 5))),
              FrameFault::none)
        << "frame " << i;
}

TEST_F(FrozenViewsTest, APatchThatComesToRestBesideNoiseIsSound) {
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(260 + 5 * std::min(i, 8)), 3, static_cast<std::uint64_t>(i))),
              FrameFault::none)
        << "frame " << i;
}

TEST_F(FrozenViewsTest, MotionBehindAnObstacleBeforeOneCameraIsNoFault) {
  for (int i = 0; i < 30; ++i) {
    Frame frame = pair_.frame(150 + 5 * i);
    cv::rectangle(frame.views[1].color, cv::Rect(0, 90, TexturedPair::kWidth, 180),
                  cv::Scalar(60, 70, 80), cv::FILLED);
    EXPECT_EQ(check(noisy(frame, 3, static_cast<std::uint64_t>(i))), FrameFault::none)
        << "frame " << i;
  }
}

TEST_F(FrozenViewsTest, AViewThatIsClippedWhereTheOtherMovesIsNoFault) {
  for (int i = 0; i < 30; ++i) {
    Frame frame = pair_.frame(260 + 5 * i);
    if (i > 5)
      cv::rectangle(frame.views[1].color,
                    cv::Rect(0, TexturedPair::kTop, TexturedPair::kWidth, TexturedPair::kSide),
                    cv::Scalar::all(255), cv::FILLED);
    const FrameFault fault = check(noisy(frame, 3, static_cast<std::uint64_t>(i)));
    if (i == 6) continue;  // it becomes brighter
    EXPECT_EQ(fault, FrameFault::none) << "frame " << i;
  }
}

TEST_F(FrozenViewsTest, SlowMotionBesideNoiseIsSound) {
  for (int i = 0; i < 40; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(280 + i / 4), 3, static_cast<std::uint64_t>(i))),
              FrameFault::none)
        << "frame " << i;
}

}  // namespace
}  // namespace hypotrack
