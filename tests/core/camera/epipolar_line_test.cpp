#include "camera/epipolar_line.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hypotrack/api/camera.hpp"

namespace hypotrack {
namespace {

Camera plain() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

Camera bent() {
  Camera camera = plain();
  camera.distortion_model = DistortionModel::brown;
  camera.distortion = {-0.3, 0.08, 0.001, -0.001, 0};
  camera.camera_from_world = Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.2, 1, 0).normalized()) *
                             Eigen::Translation3d(-0.15, 0.02, 0);
  return camera;
}

TEST(EpipolarLine, IsARowOfARectifiedPair) {
  const Camera left = plain();
  Camera right = left;
  right.camera_from_world.translation().x() = -0.1;
  const Eigen::Matrix2Xd line = epipolar_line(left, {300, 111}, right);
  ASSERT_GT(line.cols(), 10);
  for (Eigen::Index i = 0; i < line.cols(); ++i) {
    EXPECT_NEAR(line(1, i), 111, 1e-6);
    EXPECT_LE(line(0, i), 300);
  }
  EXPECT_NEAR(line(0, 0), 300, 1e-3) << "infinity";
}

TEST(EpipolarLine, HasEveryPointOfItsPixelThroughABentLens) {
  const Camera left = plain(), right = bent();
  const Eigen::Vector2d pixel(350, 300);
  const Eigen::Matrix2Xd line = epipolar_line(left, pixel, right);
  const Eigen::Vector3d ray = back_project(left, pixel);
  for (const double depth : {0.3, 0.5, 1.0, 3.0}) {
    const Eigen::Vector2d seen = project(right, depth * ray);
    EXPECT_LT(distance_from_line(line, seen), 0.2) << depth;
    EXPECT_NEAR(distance_from_line(line, seen + Eigen::Vector2d(0, 9)), 9, 1.5) << depth;
  }
}

TEST(EpipolarLine, EndsWhereTheOtherLensFoldsBack) {
  Camera fold = bent();
  fold.distortion = {-0.5, 0, 0, 0, 0};
  const Eigen::Matrix2Xd line = epipolar_line(plain(), {20, 240}, fold);
  int known = 0;
  for (Eigen::Index i = 1; i < line.cols(); ++i) {
    if (!line.col(i).allFinite()) continue;
    ++known;
    EXPECT_LT(line.col(i).cwiseAbs().maxCoeff(), 2000);
  }
  EXPECT_GT(known, 0);
  EXPECT_LT(known, line.cols() - 1);
}

TEST(EpipolarLine, IsInfinitelyFarIfThereIsNone) {
  EXPECT_TRUE(std::isinf(distance_from_line({}, {1, 2})));
}

TEST(Triangulate, FindsThePointOfTwoPixels) {
  const Camera left = plain(), right = bent();
  const Eigen::Vector3d point(0.04, -0.03, 0.6);
  EXPECT_LT((triangulate(left, project(left, point), right, project(right, point)) - point).norm(),
            1e-6);
}

TEST(Triangulate, FindsNothingBehindTheCamerasOrOnParallelRays) {
  const Camera left = plain();
  Camera right = left;
  right.camera_from_world.translation().x() = -0.1;
  EXPECT_TRUE(triangulate(left, {300, 200}, right, {340, 200}).array().isNaN().all());
  EXPECT_TRUE(triangulate(left, {300, 200}, right, {300, 200}).array().isNaN().all());
}

}  // namespace
}  // namespace hypotrack
