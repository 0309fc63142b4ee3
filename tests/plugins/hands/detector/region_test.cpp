#include "region.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "hand_picture.hpp"
#include "hypotrack/plugin/params.hpp"
#include "upright_hand.hpp"

namespace hypotrack::hands {
namespace {

TEST(HandRegion, TurnsWithTheHand) {
  const Region straight = region_of(test::upright_hand());
  EXPECT_NEAR(straight.angle, 0, 1e-9);
  for (const double degrees : {30.0, 90.0, 179.0, -120.0}) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(degrees * kDegree).toRotationMatrix();
    const Region turned = region_of(HandPoints(turn * test::upright_hand()));
    EXPECT_TRUE(rotation_of(turned).isApprox(turn, 1e-9)) << degrees;
    EXPECT_NEAR(turned.side, straight.side, 1e-9);
    EXPECT_TRUE(turned.center.isApprox(turn * straight.center, 1e-9)) << degrees;
  }
}

TEST(HandRegion, IsCutOutUpright) {
  cv::Mat picture(300, 400, CV_8UC3, cv::Scalar::all(0));
  cv::circle(picture, {250, 120}, 4, cv::Scalar::all(255), cv::FILLED);
  // The fingers point to the right, and the circle lies in their direction.
  Region region;
  region.center << 200, 120;
  region.side = 200;
  region.angle = 90 * kDegree;
  std::vector<float> cut(3 * 100 * 100, -1);
  write_region({picture, {1, 1, 1}}, region, 100, cut);
  const cv::Mat cut_picture(100, 100, CV_32FC3, cut.data());
  EXPECT_EQ(cut_picture.at<cv::Vec3f>(25, 50), cv::Vec3f(255, 255, 255));
  EXPECT_EQ(cut_picture.at<cv::Vec3f>(75, 50), cv::Vec3f(0, 0, 0));
}

TEST(HandRegion, IsNearlyEqualAfterSmallChanges) {
  Region a;
  a.center << 10, 20;
  a.side = 100;
  a.angle = 3.13;
  Region b = a;
  b.center.x() += 2;
  b.angle = -3.13;
  EXPECT_TRUE(nearly_equal(a, b, 0.05));
  b.side = 110;
  EXPECT_FALSE(nearly_equal(a, b, 0.05));
}

}  // namespace
}  // namespace hypotrack::hands
