#include "track/rig/view_timing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "textured_pair.hpp"
#include "track/loop/picture_watch.hpp"
#include "track/rig/rig_watch.hpp"

namespace hypotrack {
namespace {

using test::TexturedPair;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kSecond = 30;  // frames

/// A patch that moves before a wall, seen by a pair whose second view is late.
class ViewTimingTest : public ::testing::Test {
 protected:
  struct Motion {
    double up = 40, right = 1;  ///< pixels: amplitude, per frame
  };

  Frame frame_at(double i, const Motion& motion) const {
    const int y = TexturedPair::kTop + cvRound(motion.up * std::sin(0.25 * i));
    return test::noisy(
        pair_.frame(cvRound(280 + motion.right * i), TexturedPair::kWall, TexturedPair::kPatch, y),
        2, static_cast<std::uint64_t>(1000 + 10 * i));
  }
  Frame late_frame(int i, double late, const Motion& motion) const {
    Frame out = frame_at(i, motion);
    out.views[1] = frame_at(i - late, motion).views[1];
    out.index = i;
    out.time = i / double{kSecond};
    return out;
  }
  /// Returns by how much some frames say that the second view is late.
  std::optional<double> found(double late, const Motion& motion, int frames = kSecond) const {
    const RectifiedPair pair = RectifiedPair::make({pair_.cameras[0], pair_.cameras[1]}).value();
    ViewTiming timing(pair.disparity(0.25));
    for (int i = 0; i < frames; ++i) timing.add(pair.resample(late_frame(i, late, motion)));
    return timing.late();
  }

  TexturedPair pair_;
};

TEST_F(ViewTimingTest, PicturesOfRectifiedCamerasAreTheirOwnPixels) {
  const RectifiedPair pair = RectifiedPair::make({pair_.cameras[0], pair_.cameras[1]}).value();
  const Frame frame = frame_at(3, {});
  const GreyPair small = pair.resample(frame);
  for (std::size_t v = 0; v < 2; ++v) {
    cv::Mat grey;
    cv::cvtColor(frame.views[v].color, grey, cv::COLOR_BGR2GRAY);
    ASSERT_GE(small[v].cols, grey.cols - 1);
    EXPECT_EQ(cv::norm(small[v], grey(cv::Rect({}, small[v].size())), cv::NORM_INF), 0);
  }
}

TEST_F(ViewTimingTest, TellsByHowManyFramesEitherViewIsLate) {
  for (const int late : {-1, 0, 2}) {
    const auto told = found(late, {});
    ASSERT_TRUE(told) << late;
    EXPECT_NEAR(*told, late, 0.2);
  }
}

TEST_F(ViewTimingTest, TellsLateViewsOfFastMotionAfterAFewFrames) {
  constexpr int kFew = 8;
  EXPECT_NEAR(found(1, {}, kFew).value_or(0), 1, 0.2);
  EXPECT_FALSE(found(0, {}, kFew));
}

TEST_F(ViewTimingTest, TellsHalfAFrame) {
  const auto told = found(0.5, {.up = 12});
  ASSERT_TRUE(told);
  EXPECT_NEAR(*told, 0.5, 0.25);
}

TEST_F(ViewTimingTest, SaysNothingOfWhatStandsStillOrMovesAlongTheRows) {
  for (const int late : {0, 1}) {
    EXPECT_FALSE(found(late, {.up = 0, .right = 0}));
    EXPECT_FALSE(found(late, {.up = 0, .right = 5}));
  }
}

TEST_F(ViewTimingTest, ALateViewIsSaidWithinASecondOnceAndForgottenWhenItEnds) {
  RigWatch watch = RigWatch::make(pair_.cameras).value();
  for (int i = 0; i < kSecond; ++i) watch.look(late_frame(i, 1, {}));
  EXPECT_TRUE(watch.is_doubtful());
  EXPECT_THAT(watch.take_notes(), ElementsAre(HasSubstr("the second view is 1.0 frames late")));
  const Motion in_place{.right = 0};
  for (int i = kSecond; i < 8 * kSecond; ++i) watch.look(late_frame(i, 0, in_place));
  EXPECT_FALSE(watch.is_doubtful());
  EXPECT_THAT(watch.take_notes(), IsEmpty());
}

TEST_F(ViewTimingTest, ALateViewIsDoubtedInTheFrameThatShowsIt) {
  RigWatch alone = RigWatch::make(pair_.cameras).value();
  PictureWatch beside(pair_.cameras, {}, true);
  for (int i = 0; i < kSecond; ++i) {
    const Frame frame = late_frame(i, 1, {});
    alone.look(frame);
    const PictureWatch::FrameEnd end(beside);
    EXPECT_EQ(beside.check(frame).fault, FrameFault::none);
    EXPECT_EQ(beside.doubts_depth(i, false), alone.is_doubtful()) << i;
  }
  EXPECT_TRUE(alone.is_doubtful());
}

TEST_F(ViewTimingTest, FramesThatComeAtUnequalTimesHideNoLateView) {
  RigWatch watch = RigWatch::make(pair_.cameras).value();
  for (int i = 0; i < kSecond; ++i) {
    Frame frame = late_frame(i, 1, {});
    if (i % 7 == 1) frame.time -= 0.028;  // a burst
    watch.look(frame);
  }
  EXPECT_TRUE(watch.is_doubtful());
  EXPECT_THAT(watch.take_notes(), ElementsAre(HasSubstr("1.0 frames late (3")));
}

}  // namespace
}  // namespace hypotrack
