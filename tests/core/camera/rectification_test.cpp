#include "camera/rectification.hpp"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/calib3d.hpp>
#include <random>

#include "test_cameras.hpp"

namespace hypotrack {
namespace {

constexpr double kDegrees = M_PI / 180;

std::array<Camera, 2> pair(const Eigen::Vector3d& turn, const Eigen::Vector3d& centre) {
  std::array<Camera, 2> cameras = {test::lens_camera(0), test::lens_camera(5)};
  cameras[1].camera_from_world = test::pose(turn, {0, 0, 0});
  cameras[1].camera_from_world.translation() = -(cameras[1].camera_from_world.linear() * centre);
  return cameras;
}

TEST(Rectification, LeavesAnIdealPairAlone) {
  const auto cameras = pair({0, 0, 0}, {0.12, 0, 0});
  const IdealRig rig = make_ideal_rig(cameras);
  ASSERT_TRUE(rig.rectified);
  EXPECT_TRUE(rig.camera_from_ideal[0].isIdentity(1e-12));
  EXPECT_TRUE(rig.camera_from_ideal[1].isIdentity(1e-12));
  EXPECT_TRUE(rig.ideal_from_world[1].isApprox(cameras[1].camera_from_world, 1e-12));
}

TEST(Rectification, AlignsRowsAndMakesDisparityPositive) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d turn = 10 * kDegrees * Eigen::Vector3d(some(random), some(random), 0);
    Eigen::Vector3d centre(some(random), some(random), 0.1 * some(random));
    centre *= 0.1;
    auto cameras = pair(turn, centre);
    const Eigen::Isometry3d moved = test::pose({0.5, -0.3, 2.0}, {1, 2, 3});
    for (Camera& c : cameras) c.camera_from_world = c.camera_from_world * moved;
    const IdealRig rig = make_ideal_rig(cameras);
    if (!rig.rectified) continue;
    const Eigen::Vector3d p = moved.inverse() * Eigen::Vector3d(0.1 * some(random), 0.05, 0.6);
    const Eigen::Vector3d a = rig.ideal_from_world[0] * p;
    const Eigen::Vector3d b = rig.ideal_from_world[1] * p;
    EXPECT_NEAR(a.y(), b.y(), 1e-12);
    EXPECT_NEAR(a.z(), b.z(), 1e-12);
    EXPECT_NEAR(a.x() - b.x(), centre.norm(), 1e-12);
    // The ideal cameras are the real ones, turned.
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d real = cameras[i].camera_from_world * p;
      EXPECT_TRUE((rig.camera_from_ideal[i] * (i ? b : a)).isApprox(real, 1e-12));
    }
  }
}

TEST(Rectification, AgreesWithOpenCvUpToATurnAboutTheBaseline) {
  const auto cameras = pair({0.03, -0.05, 0.02}, {0.12, 0.004, -0.003});
  const IdealRig rig = make_ideal_rig(cameras);
  ASSERT_TRUE(rig.rectified);
  cv::Matx33d r;
  cv::Vec3d t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = cameras[1].camera_from_world.linear()(i, j);
    t[i] = cameras[1].camera_from_world.translation()[i];
  }
  const cv::Matx33d k(700, 0, 640, 0, 700, 360, 0, 0, 1);
  cv::Matx33d r1, r2;
  cv::Matx34d p1, p2;
  cv::Matx44d q;
  cv::stereoRectify(k, cv::noArray(), k, cv::noArray(), cv::Size(1280, 720), r, t, r1, r2, p1, p2,
                    q);
  Eigen::Matrix3d theirs;
  for (int i = 0; i < 9; ++i) theirs(i / 3, i % 3) = r1.val[i];
  const Eigen::Matrix3d difference = theirs * rig.camera_from_ideal[0];
  EXPECT_NEAR(difference(0, 0), 1, 1e-9);  // same x axis: the baseline
  EXPECT_LT(Eigen::AngleAxisd(difference).angle(), 2 * kDegrees);
}

TEST(Rectification, TakesVerticalSwappedAndRolledPairs) {
  EXPECT_TRUE(make_ideal_rig(pair({0, 0, 0}, {0, 0.12, 0})).rectified);
  EXPECT_TRUE(make_ideal_rig(pair({0, 0, 0}, {-0.12, 0, 0})).rectified);
  EXPECT_TRUE(make_ideal_rig(pair({0, 0, 1.5}, {0.12, 0, 0})).rectified);
  EXPECT_TRUE(make_ideal_rig(pair({0, 25 * kDegrees, 0}, {0.117, 0, 0.026})).rectified);
}

TEST(Rectification, RefusesWideAnglesForwardMotionAndNoBaseline) {
  EXPECT_FALSE(make_ideal_rig(pair({0, 44 * kDegrees, 0}, {0.3, 0, 0})).rectified);
  EXPECT_FALSE(make_ideal_rig(pair({0, 0, 0}, {0, 0, 0.12})).rectified);
  EXPECT_FALSE(make_ideal_rig(pair({0, 0, 0}, {0.12, 0, 0.06})).rectified);
  EXPECT_FALSE(make_ideal_rig(pair({0, 0, 0}, {0, 0, 0})).rectified);
  EXPECT_FALSE(make_ideal_rig(pair({0, M_PI, 0}, {0.12, 0, 0})).rectified);
}

TEST(Rectification, KeepsTheAxesOfEveryOtherRig) {
  const auto two = pair({0, 1, 0}, {0.5, 0, 0});
  const std::vector<Camera> three = {two[0], two[1], two[1]};
  const IdealRig rig = make_ideal_rig(three);
  EXPECT_FALSE(rig.rectified);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(rig.camera_from_ideal[i].isIdentity(1e-12));
    EXPECT_TRUE(rig.ideal_from_world[i].isApprox(three[i].camera_from_world, 1e-12));
  }
}

}  // namespace
}  // namespace hypotrack
