#include "hand_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hypotrack::hands {
namespace {

std::array<Camera, 2> pair() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 600;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.distortion_model = DistortionModel::brown;
  camera.distortion = {0.05, -0.02, 0.001, 0.001};
  std::array<Camera, 2> cameras{camera, camera};
  cameras[1].camera_from_world.translation().x() = -0.1;
  return cameras;
}

/// An open hand before the cameras, its middle knuckle 90 mm from the wrist.
HandPoints3D hand_at(const Eigen::Vector3d& place) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-0.06, 0.06);
  HandPoints3D out;
  for (Eigen::Index i = 0; i < out.cols(); ++i)
    out.col(i) = place + Eigen::Vector3d(offset(random), offset(random), offset(random) / 4);
  out.col(9) = out.col(0) + Eigen::Vector3d(0, -0.09, 0);
  return out;
}

HandDetection seen(const Camera& camera, const HandPoints3D& hand, double right) {
  HandDetection out;
  for (Eigen::Index i = 0; i < hand.cols(); ++i)
    out.landmarks.col(i) = project(camera, hand.col(i));
  out.right = right;
  return out;
}

TEST(Triangulate, ReturnsThePointsThatWereProjected) {
  const auto cameras = pair();
  const HandPoints3D hand = hand_at({0.02, 0.01, 0.5});
  const HandPoints3D found = triangulate(cameras, seen(cameras[0], hand, 1).landmarks,
                                         seen(cameras[1], hand, 1).landmarks);
  EXPECT_LT((found - hand).colwise().norm().maxCoeff(), 1e-5);
}

TEST(Triangulate, KnowsNoPointBehindTheCameras) {
  const auto cameras = pair();
  const HandPoints3D hand = hand_at({0.02, 0.01, 0.5});
  const HandPoints3D found = triangulate(cameras, seen(cameras[1], hand, 1).landmarks,
                                         seen(cameras[0], hand, 1).landmarks);
  EXPECT_TRUE(found.array().isNaN().all());
}

TEST(PairHands, KeepsHandsApartThatLieOnOneLine) {
  const auto cameras = pair();
  // Both views see both hands at the same height, so that any of four pairs could be right.
  const HandPoints3D near = hand_at({0.05, 0, 0.45}), far = hand_at({-0.08, 0, 0.6});
  const std::vector<HandDetection> first{seen(cameras[0], near, 0.9), seen(cameras[0], far, 0.1)};
  const std::vector<HandDetection> second{seen(cameras[1], far, 0.2), seen(cameras[1], near, 0.8)};
  const std::vector<HandPair> pairs = pair_hands(cameras, first, second);
  ASSERT_EQ(pairs.size(), 2U);
  for (const HandPair& one : pairs) {
    const HandPoints3D& truth = one.right > 0.5 ? near : far;
    EXPECT_LT((one.landmarks - truth).colwise().norm().maxCoeff(), 1e-4);
  }
}

TEST(PairHands, RefusesWhatIsNoHandOfAPerson) {
  const auto cameras = pair();
  const HandPoints3D hand = hand_at({0, 0, 0.5});
  const HandPoints3D other = hand.colwise() + Eigen::Vector3d(0, 0.08, 0);
  const std::vector<HandDetection> first{seen(cameras[0], hand, 0.9)};
  EXPECT_TRUE(pair_hands(cameras, first, std::vector{seen(cameras[1], other, 0.9)}).empty());
  const HandPoints3D giant = 3 * hand;
  EXPECT_TRUE(pair_hands(cameras, std::vector{seen(cameras[0], giant, 0.9)},
                         std::vector{seen(cameras[1], giant, 0.9)})
                  .empty());
  EXPECT_TRUE(pair_hands(cameras, first, {}).empty());
}

}  // namespace
}  // namespace hypotrack::hands
