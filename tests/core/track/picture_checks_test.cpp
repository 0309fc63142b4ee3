#include "track/faults/picture_checks.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "textured_pair.hpp"

namespace hypotrack {
namespace {

using test::noisy;
using test::TexturedPair;

using PictureChecksTest = test::TexturedPairChecks;

void exchange(Frame& frame) { std::swap(frame.views[0], frame.views[1]); }

TEST_F(PictureChecksTest, AMovingPatchIsSound) { expect_sound(200, 7, 10); }

TEST_F(PictureChecksTest, NoisyPicturesAreSound) {
  for (std::uint64_t i = 0; i < 6; ++i)
    EXPECT_EQ(check(noisy(pair_.frame(300), 5, i)), FrameFault::none) << "frame " << i;
}

TEST_F(PictureChecksTest, StillViewsAreSound) { expect_sound(300, 0, 5); }

TEST_F(PictureChecksTest, AFrozenViewIsNamedUntilItMovesAgain) {
  expect_sound(260, 5, 4);
  const View still = pair_.frame(275).views[1];
  for (int i = 0; i < 5; ++i) {
    Frame frame = pair_.frame(280 + 5 * i);
    frame.views[1] = still;
    EXPECT_EQ(check(frame), FrameFault::frozen) << "frame " << i;
    EXPECT_EQ(last_.view, 1);
  }
  expect_sound(305, 5, 3);
  Frame frame = pair_.frame(330);
  frame.views[0] = pair_.frame(315).views[0];
  EXPECT_EQ(check(frame), FrameFault::frozen);
  EXPECT_EQ(last_.view, 0);
}

TEST_F(PictureChecksTest, AFrozenViewStaysWrongWhileTheOtherStopsElsewhere) {
  expect_sound(280, 0, 2);
  Frame frame = pair_.frame(310);
  frame.views[1] = pair_.frame(280).views[1];
  EXPECT_EQ(check(frame), FrameFault::frozen);
  EXPECT_EQ(check(frame), FrameFault::frozen);
}

TEST_F(PictureChecksTest, AFrozenViewBesideNoiseIsFound) {
  const Frame first = noisy(pair_.frame(280), 3, 1);
  EXPECT_EQ(check(first), FrameFault::none);
  Frame frame = noisy(pair_.frame(290), 3, 2);
  frame.views[1] = first.views[1];
  EXPECT_EQ(check(frame), FrameFault::frozen);
}

TEST_F(PictureChecksTest, MotionThatOneCameraAloneSeesIsNoFault) {
  // Left of what the second camera sees, however far away it is.
  const View still = pair_.frame(-TexturedPair::kSide).views[1];
  for (int i = 0; i < 4; ++i) {
    Frame frame = pair_.frame(10 * i - 100);
    frame.views[1] = still;
    EXPECT_EQ(check(frame), FrameFault::none) << "frame " << i;
  }
}

TEST_F(PictureChecksTest, OnePictureInBothViewsIsNamed) {
  Frame frame = pair_.frame(300);
  frame.views[1].color = frame.views[0].color.clone();
  EXPECT_EQ(check(frame), FrameFault::same_picture);
  for (View& view : frame.views) view.color.setTo(cv::Scalar(90, 80, 70));
  EXPECT_EQ(check(frame), FrameFault::none) << "without texture two cameras may show the same";
}

TEST_F(PictureChecksTest, ExchangedViewsAreNamedFromTheFirstFrameOn) {
  for (std::uint64_t i = 0; i < 3; ++i) {
    Frame frame = noisy(pair_.frame(300 + 5 * static_cast<int>(i)), 3, i);
    exchange(frame);
    EXPECT_EQ(check(frame), FrameFault::exchanged);
  }
  EXPECT_EQ(check(noisy(pair_.frame(320), 3, 9)), FrameFault::none);
}

TEST_F(PictureChecksTest, ExchangedViewsOfUnequalExposureAreNamed) {
  Frame frame = pair_.frame(300);
  frame.views[1].color.convertTo(frame.views[1].color, -1, 1.3, 5);
  EXPECT_EQ(check(frame), FrameFault::none);
  exchange(frame);
  EXPECT_EQ(check(frame), FrameFault::exchanged);
}

TEST_F(PictureChecksTest, ViewsOfAFarSceneMayBeExchangedUnnoticed) {
  // 6 m away: a calibration that is a little off may exchange the sides, too.
  Frame frame = noisy(pair_.frame(-TexturedPair::kSide, 7), 2, 1);
  EXPECT_EQ(check(frame), FrameFault::none);
  exchange(frame);
  EXPECT_EQ(check(frame), FrameFault::none);
}

TEST_F(PictureChecksTest, ViewsWithoutTextureAreSound) {
  Frame frame = pair_.frame(300);
  for (View& view : frame.views) view.color.setTo(cv::Scalar(90, 80, 70));
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(check(noisy(frame, 4, i)), FrameFault::none);
}

TEST_F(PictureChecksTest, BlackAndWhiteViewsAreNamed) {
  expect_sound(280, 5, 2);
  Frame frame = pair_.frame(290);
  frame.views[1].color.setTo(cv::Scalar::all(3));
  EXPECT_EQ(check(noisy(frame, 2, 1)), FrameFault::black);
  EXPECT_EQ(last_.view, 1);
  frame = pair_.frame(290);
  frame.views[0].color.setTo(cv::Scalar::all(255));
  EXPECT_EQ(check(frame), FrameFault::saturated);
  EXPECT_EQ(last_.view, 0);
  expect_sound(290, 5, 2);
}

TEST_F(PictureChecksTest, ABlackFirstFrameIsNamed) {
  Frame frame = pair_.frame(290);
  for (View& view : frame.views) view.color.setTo(0);
  EXPECT_EQ(check(frame), FrameFault::black);
  EXPECT_EQ(check(frame), FrameFault::black);
}

TEST_F(PictureChecksTest, ABlackBackgroundIsNoFaultOnceThePatchLeaves) {
  Frame frame = pair_.frame(-TexturedPair::kSide);
  for (View& view : frame.views) {
    view.color.setTo(0);
    cv::rectangle(view.color, cv::Rect(300, 100, 80, 80), cv::Scalar::all(150), cv::FILLED);
  }
  EXPECT_EQ(check(frame), FrameFault::none);
  for (View& view : frame.views) view.color.setTo(0);
  EXPECT_EQ(check(frame), FrameFault::none);
}

TEST_F(PictureChecksTest, JumpsOfBrightnessAreNamedOnce) {
  const auto with_gain = [&](int x, double first, double second) {
    Frame frame = pair_.frame(x);
    frame.views[0].color *= first;
    frame.views[1].color *= second;
    return frame;
  };
  EXPECT_EQ(check(with_gain(280, 0.5, 0.5)), FrameFault::none);
  EXPECT_EQ(check(with_gain(285, 0.5, 1)), FrameFault::brightness);
  EXPECT_EQ(last_.view, 1);
  EXPECT_EQ(check(with_gain(290, 0.5, 1)), FrameFault::none);
  EXPECT_EQ(check(with_gain(295, 0.2, 0.4)), FrameFault::brightness);
  EXPECT_EQ(check(with_gain(300, 0.2, 0.4)), FrameFault::none);
  EXPECT_EQ(check(with_gain(305, 0.22, 0.37)), FrameFault::none) << "an exposure that adapts";
  EXPECT_NEAR(checks_.drifts()[0], 1.1, 0.02);
  EXPECT_NEAR(checks_.drifts()[1], 0.92, 0.02);
}

TEST_F(PictureChecksTest, AStillViewWhoseOtherBecomesBrighterIsNotFrozen) {
  expect_sound(280, 0, 2);
  Frame frame = pair_.frame(280);
  frame.views[0].color *= 1.2;
  EXPECT_EQ(check(frame), FrameFault::none);
}

TEST_F(PictureChecksTest, OneViewAndDepthViewsAreLeftAlone) {
  PictureChecks one({pair_.cameras[0]}, true);
  Frame frame = pair_.frame(280);
  frame.views.resize(1);
  EXPECT_EQ(one.check(frame).fault, FrameFault::none);
  EXPECT_EQ(one.check(frame).fault, FrameFault::none);
  // Depth does not depend on the light.
  frame.views[0].depth = cv::Mat1f(frame.views[0].color.size(), 0.5F);
  frame.views[0].color.setTo(0);
  EXPECT_EQ(one.check(frame).fault, FrameFault::none);
  frame.views[0].color.release();
  EXPECT_EQ(one.check(frame).fault, FrameFault::none);
}

TEST_F(PictureChecksTest, DepthThatIsNowhereMeasuredShowsNothingToWhoReadsIt) {
  Frame frame = pair_.frame(280);
  for (View& view : frame.views) view.depth = cv::Mat1f(view.color.size(), 0.5F);
  frame.views[1].depth.setTo(0);
  EXPECT_EQ(check(frame), FrameFault::none) << "only colours are compared";
  PictureChecks with_depth(pair_.cameras, true);
  const ViewFault found = with_depth.check(frame);
  EXPECT_EQ(found.fault, FrameFault::black);
  EXPECT_EQ(found.view, 1);
  frame.views[1].depth.at<float>(200, 300) = 0.7F;
  EXPECT_EQ(with_depth.check(frame).fault, FrameFault::none);
}

TEST_F(PictureChecksTest, AFrozenThirdViewIsNamed) {
  std::vector<Camera> cameras = pair_.cameras;
  cameras.push_back(cameras[0]);
  cameras[2].camera_from_world.translation().x() = -0.06;
  PictureChecks three(cameras, false);
  const auto frame = [&](int x, int third) {
    Frame out = pair_.frame(x);
    out.views.push_back(
        pair_.frame(third, TexturedPair::kWall / 2, TexturedPair::kPatch / 2).views[1]);
    return out;
  };
  EXPECT_EQ(three.check(frame(280, 280)).fault, FrameFault::none);
  EXPECT_EQ(three.check(frame(290, 290)).fault, FrameFault::none);
  const ViewFault found = three.check(frame(300, 290));
  EXPECT_EQ(found.fault, FrameFault::frozen);
  EXPECT_EQ(found.view, 2);
}

}  // namespace
}  // namespace hypotrack
