#include "track/rig/rig_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "textured_pair.hpp"

namespace hypotrack {
namespace {

using test::noisy;
using test::TexturedPair;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kFrames = 33;  // a second
constexpr double kRate = 30;

/// Rendered frames of a patch that goes up and down before a wall.
class RigWatchTest : public ::testing::Test {
 protected:
  Frame frame(int i) const {
    const int y = TexturedPair::kTop + cvRound(40 * std::sin(0.2 * i));
    Frame out = pair_.frame(300 + i, TexturedPair::kWall, TexturedPair::kPatch, y);
    out.index = i;
    out.time = i / kRate;
    return out;
  }

  TexturedPair pair_;
  RigWatch watch_ = RigWatch::make(pair_.cameras).value();
};

/// Shifts, rolls and scales a picture about the middle of TexturedPair's pictures.
cv::Mat moved(const cv::Mat& picture, double roll, double scale, double down) {
  const double c = scale * std::cos(roll), s = scale * std::sin(roll);
  const double x = (TexturedPair::kWidth - 1) / 2.0, y = (TexturedPair::kHeight - 1) / 2.0;
  const cv::Matx23d map(c, -s, x - c * x + s * y, s, c, y - s * x - c * y + down);
  cv::Mat out;
  cv::warpAffine(picture, out, map, picture.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return out;
}

TEST_F(RigWatchTest, SoundPicturesAreSilent) {
  for (int i = 0; i < 2 * kFrames; ++i)
    watch_.look(noisy(frame(i), 3, static_cast<std::uint64_t>(i)));
  EXPECT_THAT(watch_.take_notes(), IsEmpty());
  EXPECT_FALSE(watch_.is_doubtful());
  EXPECT_LT(watch_.estimate().row_error, 0.3);
  const Frame last = frame(0);
  EXPECT_EQ(corrected(last, watch_.correction()).views[1].color.data, last.views[1].color.data);
}

TEST_F(RigWatchTest, RowsRollAndScaleAreMeasuredFromTheFirstFrameAndUndone) {
  constexpr double kRoll = 0.01, kScale = 1.01, kDown = 4;
  Frame now = frame(0);
  const cv::Mat right = now.views[1].color;
  now.views[1].color = moved(right, kRoll, kScale, kDown);
  watch_.look(now);
  EXPECT_NEAR(watch_.estimate().rows, kDown, 0.3);
  EXPECT_NEAR(watch_.estimate().roll, kRoll, 0.002);
  EXPECT_NEAR(watch_.estimate().scale, kScale - 1, 0.004);
  EXPECT_THAT(watch_.take_notes(),
              ElementsAre(AllOf(HasSubstr("frame 0:"), HasSubstr("rows too low"),
                                HasSubstr("clockwise"), HasSubstr("hypotrack calibration check"))));
  EXPECT_FALSE(watch_.is_doubtful());
  const cv::Rect inside(40, 40, TexturedPair::kWidth - 80, TexturedPair::kHeight - 80);
  const auto difference = [&](const cv::Mat& picture) {
    return cv::norm(picture(inside), right(inside), cv::NORM_L1) / (3.0 * inside.area());
  };
  EXPECT_GT(difference(now.views[1].color), 8);
  EXPECT_LT(difference(corrected(now, watch_.correction()).views[1].color), 4);
}

TEST_F(RigWatchTest, CamerasAboveEachOtherAreWatchedToo) {
  std::vector<Camera> cameras = pair_.cameras;
  for (Camera& camera : cameras) {
    std::swap(camera.width, camera.height);
    std::swap(camera.cx, camera.cy);
  }
  cameras[1].camera_from_world.translation() << 0, -0.12, 0;
  Frame now = frame(0);
  for (View& view : now.views) cv::rotate(view.color, view.color, cv::ROTATE_90_CLOCKWISE);
  const cv::Mat below = now.views[1].color.clone();
  cv::warpAffine(below, now.views[1].color, cv::Matx23d(1, 0, 5, 0, 1, 0), below.size(),
                 cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  RigWatch watch = RigWatch::make(cameras).value();
  watch.look(now);
  EXPECT_NEAR(std::abs(watch.estimate().rows), 5, 0.3);
  const cv::Rect inside(40, 40, TexturedPair::kHeight - 80, TexturedPair::kWidth - 80);
  EXPECT_LT(cv::norm(corrected(now, watch.correction()).views[1].color(inside), below(inside),
                     cv::NORM_L1),
            3.0 * 2 * inside.area());
}

TEST_F(RigWatchTest, PicturesThatAreFarOffAreDoubtful) {
  Frame now = frame(0);
  now.views[1].color = moved(now.views[1].color, 0, 1, 12);
  watch_.look(now);
  EXPECT_TRUE(watch_.is_doubtful());
}

TEST_F(RigWatchTest, PicturesWithoutTextureSayNothing) {
  for (int i = 0; i < kFrames; ++i) {
    Frame now = frame(i);
    for (View& view : now.views) view.color.setTo(cv::Scalar(90, 100, 110));
    watch_.look(noisy(now, 3, static_cast<std::uint64_t>(i)));
  }
  EXPECT_THAT(watch_.take_notes(), IsEmpty());
}

TEST_F(RigWatchTest, AChangeOfBrightnessIsSaidOnce) {
  for (int i = 0; i < 20; ++i) {
    ColorMap colors;
    for (std::size_t c = 0; c < 3; ++c) colors.gain[c] = 1 + 0.05F * static_cast<float>(i);
    watch_.look_at_colors(i, colors);
  }
  EXPECT_THAT(watch_.take_notes(), ElementsAre(HasSubstr("times as bright as at the start")));
}

TEST_F(RigWatchTest, TurnsThatAreFarAndSureAreSaidOnce) {
  constexpr double kDegree = 0.017453;
  for (int i = 0; i < 60; ++i) {
    watch_.look_at_turn(i, {0.1 * kDegree, 0.05 * kDegree, 0.5});  // 0.6 pixels
    watch_.look_at_turn(i, {1 * kDegree, 0.5 * kDegree, 0.5});     // hardly known
  }
  for (int i = 60; i < 96; ++i)  // half of the frames say nothing
    watch_.look_at_turn(i, {(i % 2) * 0.5 * kDegree, 0.05 * kDegree, 0.5});
  for (int i = 100; i < 112; ++i)  // colours are learned anew
    watch_.look_at_turn(i, {0.5 * kDegree, 0.05 * kDegree, 0.5});
  EXPECT_THAT(watch_.take_notes(), IsEmpty());
  for (int i = 112; i < 180; ++i) watch_.look_at_turn(i, {-0.5 * kDegree, 0.05 * kDegree, 0.5});
  EXPECT_THAT(watch_.take_notes(),
              ElementsAre(AllOf(HasSubstr("0.50 degrees outwards"), HasSubstr("3.6 % too short"),
                                HasSubstr("status.correct_turn"))));
  EXPECT_FALSE(watch_.correction());
}

TEST_F(RigWatchTest, TurnsThatPutDepthWrongAreDoubtfulUnlessUndone) {
  RigWatch undoing = RigWatch::make(pair_.cameras, true).value();
  for (int i = 0; i < 24; ++i) {
    watch_.look_at_turn(i, {0.01, 0.001, 0.9});
    undoing.look_at_turn(i, {0.01, 0.001, 0.9});
  }
  EXPECT_TRUE(watch_.is_doubtful());
  EXPECT_FALSE(undoing.is_doubtful());
}

TEST_F(RigWatchTest, TurnsThatNoCameraTakesAreNotFollowed) {
  RigWatch watch = RigWatch::make(pair_.cameras, true).value();
  for (int i = 0; i < 500; ++i) watch.look_at_turn(i, {0.02, 0.001, 0.5});
  const double moved = std::abs((*watch.correction())(0, 2)) / pair_.cameras[1].fx;
  EXPECT_LT(moved, 0.1);
  const auto unknown = std::numeric_limits<double>::quiet_NaN();
  for (int i = 500; i < 600; ++i) watch.look_at_turn(i, {unknown, 0.001, 0.5});
  EXPECT_TRUE(std::isfinite((*watch.correction())(0, 2)));
}

TEST_F(RigWatchTest, TurnsAreUndoneOnRequest) {
  constexpr double kTurn = 0.02;
  const Camera& camera = pair_.cameras[1];
  const cv::Matx33d pixels(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Matx33d back(std::cos(kTurn), 0, -std::sin(kTurn), 0, 1, 0, std::sin(kTurn), 0,
                         std::cos(kTurn));
  RigWatch watch = RigWatch::make(pair_.cameras, true).value();
  const auto undone = [&] {
    const cv::Vec3d axis =
        watch.correction().value_or(cv::Matx33d::eye()) * cv::Vec3d(camera.cx, camera.cy, 1);
    return std::atan((axis[0] / axis[2] - camera.cx) / camera.fx);
  };
  for (int i = 0; i < 200; ++i)  // outlines show a part of what is left
    watch.look_at_turn(i, {0.7 * (kTurn - undone()), 0.001, 0.5});
  EXPECT_THAT(watch.take_notes(), ElementsAre(HasSubstr("pictures are moved to fit")));
  EXPECT_NEAR(undone(), kTurn, 0.01 * kTurn);
  Frame now = frame(0);
  const cv::Mat right = now.views[1].color.clone();
  cv::warpPerspective(right, now.views[1].color, pixels * back * pixels.inv(), right.size(),
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  const cv::Rect inside(40, 40, TexturedPair::kWidth - 80, TexturedPair::kHeight - 80);
  const auto difference = [&](const cv::Mat& picture) {
    return cv::norm(picture(inside), right(inside), cv::NORM_L1) / (3.0 * inside.area());
  };
  EXPECT_GT(difference(now.views[1].color), 8);
  EXPECT_LT(difference(corrected(now, watch.correction()).views[1].color), 2);
}

TEST_F(RigWatchTest, CamerasThatAreNotParallelAreNotWatched) {
  std::vector<Camera> cameras = pair_.cameras;
  cameras[1].camera_from_world.linear() =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_FALSE(RigWatch::make(cameras));
  cameras.pop_back();
  EXPECT_FALSE(RigWatch::make(cameras));
}

}  // namespace
}  // namespace hypotrack
