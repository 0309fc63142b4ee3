#include "camera/pair_check.hpp"

#include <gmock/gmock.h>

#include <array>
#include <numbers>

namespace hypotrack {
namespace {

using testing::HasSubstr;

/// What is said of two cameras, the second at `position` and turned about its y axis.
std::string said(const Eigen::Vector3d& position, double turned_deg = 0) {
  std::array<Camera, 2> cameras;
  cameras[0].camera_from_world.setIdentity();
  cameras[0].camera_from_world.translate(Eigen::Vector3d(3, 2, 1));
  Eigen::Isometry3d first_from_second = Eigen::Isometry3d::Identity();
  first_from_second.translate(position);
  first_from_second.rotate(
      Eigen::AngleAxisd(turned_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitY()));
  cameras[1].camera_from_world = first_from_second.inverse() * cameras[0].camera_from_world;
  return problem_of_pair(cameras);
}

TEST(PairCheck, FindsASecondCameraToTheLeft) {
  EXPECT_THAT(said({-0.12, 0.01, 0}), HasSubstr("120 mm to the left of the first"));
  EXPECT_THAT(said({-0.12, 0, 0.02}, 15), HasSubstr("to the left"));
  EXPECT_EQ(said({0.12, 0.01, 0}), "");
}

TEST(PairCheck, LeavesOtherRigsAlone) {
  EXPECT_EQ(said({-0.01, 0.12, 0}), "") << "one above the other";
  EXPECT_EQ(said({-0.5, 0, 0.1}, 44), "") << "from two sides";
  EXPECT_EQ(said({-0.01, 0, 0.1}), "") << "one behind the other";
}

TEST(PairCheck, NeedsTwoCameras) { EXPECT_EQ(problem_of_pair(std::array<Camera, 1>()), ""); }

}  // namespace
}  // namespace hypotrack
