#include "calibrate/check/match_check.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace hypotrack::calibrate {
namespace {

/// A rectified pair that looks at a wall with stains, 0.5 m away.
class MatchCheckTest : public testing::Test {
 protected:
  MatchCheckTest() {
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world.setIdentity();
    cameras_ = {camera, camera};
    cameras_[1].camera_from_world.translation().x() = -0.06;
    cv::RNG random(3);
    cv::Mat3b wall(480, 800, cv::Vec3b(120, 130, 140));
    for (int i = 0; i < 400; ++i)
      cv::circle(wall, {random.uniform(0, 800), random.uniform(0, 480)}, random.uniform(3, 14),
                 cv::Scalar(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255)),
                 cv::FILLED);
    left_ = wall(cv::Rect(60, 0, 640, 480)).clone();
    right_ = wall(cv::Rect(120, 0, 640, 480)).clone();  // 60 px of disparity
  }

  std::array<Camera, 2> cameras_;
  cv::Mat left_, right_;
};

TEST_F(MatchCheckTest, ARightCalibrationHasItsMatchesOnTheEpipolarLines) {
  const MatchCheck check = check_matches(cameras_, left_, right_);
  EXPECT_GT(check.matches, 50);
  EXPECT_LT(check.distance, 0.2);
  EXPECT_GT(check.consistent, 0.8);
  EXPECT_FALSE(check.looks_exchanged());
  EXPECT_TRUE(check.points.flat);
  ASSERT_FALSE(check.points.depths.empty());
  EXPECT_NEAR(check.points.depths[0], 0.5, 0.02);
  EXPECT_EQ(check.points.pixels[1].size(), check.points.depths.size());
}

TEST_F(MatchCheckTest, PointsAtTwoDepthsAreNotFlat) {
  cv::Mat wall;
  cv::warpAffine(right_, wall, cv::Matx23d(1, 0, 30, 0, 1, 0), right_.size());
  wall.rowRange(0, 240).copyTo(right_.rowRange(0, 240));
  EXPECT_FALSE(check_matches(cameras_, left_, right_).points.flat);
}

TEST_F(MatchCheckTest, AShiftOfRowsIsMeasured) {
  cv::Mat lower;
  cv::warpAffine(right_, lower, cv::Matx23d(1, 0, 0, 0, 1, 3), right_.size());
  const MatchCheck check = check_matches(cameras_, left_, lower);
  EXPECT_NEAR(std::abs(check.offset), 3, 0.2);
  EXPECT_NEAR(check.distance, 3, 0.2);
}

TEST_F(MatchCheckTest, ExchangedPicturesAreRecognised) {
  EXPECT_TRUE(check_matches(cameras_, right_, left_).looks_exchanged());
}

TEST_F(MatchCheckTest, PicturesOfOneColourHaveNoMatches) {
  EXPECT_EQ(check_matches(cameras_, cv::Mat3b(480, 640, cv::Vec3b(9, 9, 9)), right_).matches, 0);
}

}  // namespace
}  // namespace hypotrack::calibrate
