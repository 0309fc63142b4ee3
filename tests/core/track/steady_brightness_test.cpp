#include "track/faults/steady_brightness.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hypotrack {
namespace {

Frame frame_of(int first, int second) {
  Frame out;
  for (const int level : {first, second})
    out.views.push_back({cv::Mat(2, 3, CV_8UC3, cv::Scalar::all(level)), {}, {}});
  return out;
}

int level_of(const Frame& frame, std::size_t view) {
  return frame.views[view].color.at<cv::Vec3b>(0, 0)[0];
}

TEST(SteadyBrightness, LeavesPicturesAloneThatDidNotJump) {
  SteadyBrightness brightness;
  const Frame frame = frame_of(60, 70);
  EXPECT_EQ(brightness.applied_to(frame).views[1].color.data, frame.views[1].color.data);
  brightness.next(std::array{1.0F, 1.0F});
  EXPECT_EQ(brightness.applied_to(frame).views[1].color.data, frame.views[1].color.data);
}

TEST(SteadyBrightness, TakesAJumpOutOfItsViewUntilItIsUndone) {
  SteadyBrightness brightness;
  brightness.next(std::array{1.0F, 3.0F});
  for (int i = 0; i < 2; ++i) {
    const Frame frame = frame_of(60, 210);
    const Frame steady = brightness.applied_to(frame);
    EXPECT_EQ(level_of(steady, 0), 60);
    EXPECT_EQ(level_of(steady, 1), 70);
    EXPECT_EQ(level_of(frame, 1), 210) << "the source's picture must stay";
    brightness.next(std::array{1.0F, 1.0F});
  }
  brightness.next(std::array{1.0F, 0.34F});
  EXPECT_EQ(level_of(brightness.applied_to(frame_of(60, 70)), 1), 70);
}

}  // namespace
}  // namespace hypotrack
