#include "hypotrack/api/camera.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>

#include "camera/lens/distortion.hpp"
#include "hypotrack/api/error.hpp"
#include "test_cameras.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class CameraLens : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(AllModels, CameraLens, testing::Values(0, 4, 5, 8, 12, 14, -4));

TEST_P(CameraLens, ProjectsAsOpenCvDoes) {
  Camera camera = test::lens_camera(GetParam());
  const Eigen::Vector3d turn(0.1, -0.2, 0.05);
  camera.camera_from_world = test::pose(turn, {0.02, -0.01, 0.04});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-0.4, 0.4);
  std::uniform_real_distribution<double> depth(0.3, 1.2);
  std::vector<Eigen::Vector3d> points = {{0, 0, 0.5}};
  for (int i = 0; i < 200; ++i) points.emplace_back(side(random), side(random), depth(random));
  std::vector<cv::Point3d> objects;
  for (const Eigen::Vector3d& p : points) objects.emplace_back(p.x(), p.y(), p.z());

  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Vec3d rotation(turn.x(), turn.y(), turn.z());
  const cv::Vec3d translation(0.02, -0.01, 0.04);
  std::vector<cv::Point2d> expected;
  if (camera.distortion_model == DistortionModel::fisheye) {
    cv::fisheye::projectPoints(objects, expected, rotation, translation, k, camera.distortion);
  } else {
    cv::projectPoints(objects, rotation, translation, k, camera.distortion, expected);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = project(camera, points[i]);
    EXPECT_NEAR(pixel.x(), expected[i].x, 1e-9) << i;
    EXPECT_NEAR(pixel.y(), expected[i].y, 1e-9) << i;
  }
}

TEST_P(CameraLens, BackProjectsToTheRayOfAPixel) {
  Camera camera = test::lens_camera(GetParam());
  std::mt19937 random(8);
  std::uniform_real_distribution<double> side(-0.4, 0.4);
  Eigen::Matrix3Xd rays(3, 100);
  Eigen::Matrix2Xd pixels(2, 100);
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    rays.col(i) << side(random), side(random), 1;
    pixels.col(i) = project(camera, 0.6 * rays.col(i));
  }
  EXPECT_LT((back_project(camera, pixels) - rays).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Camera, PutsAPointOnTheAxisAtThePrincipalPoint) {
  for (const int lens : {0, 4, 5, 8, 12, 14, -4}) {
    const Camera camera = test::lens_camera(lens);
    const Eigen::Vector2d pixel = project(camera, {0, 0, 0.7});
    EXPECT_DOUBLE_EQ(pixel.x(), camera.cx);
    EXPECT_DOUBLE_EQ(pixel.y(), camera.cy);
  }
}

TEST(Camera, ProjectsNothingAtOrBehindItself) {
  const Camera camera = test::lens_camera(5);
  EXPECT_TRUE(project(camera, {0.1, 0.1, 0}).array().isNaN().all());
  EXPECT_TRUE(project(camera, {0.1, 0.1, -1}).array().isNaN().all());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(project(camera, {0, 0, nan}).array().isNaN().all());
}

TEST(Camera, KnowsWhereItsLensFoldsBack) {
  Camera camera = test::lens_camera(0);
  EXPECT_TRUE(std::isinf(monotonic_radius(camera)));
  camera.distortion_model = DistortionModel::brown;
  camera.distortion = {-0.28, 0, 0, 0};
  // d/dr (r - 0.28 r^3) = 0
  EXPECT_NEAR(monotonic_radius(camera), std::sqrt(1 / 0.84), 5e-3);
  camera.distortion = {0.1, 0, 0, 0};
  EXPECT_TRUE(std::isinf(monotonic_radius(camera)));
}

TEST(Camera, IsValidWithEveryLens) {
  for (const int lens : {0, 4, 5, 8, 12, 14, -4})
    EXPECT_NO_THROW(validate(test::lens_camera(lens), "c"));
}

TEST(Camera, SaysWhatIsWrongWithIt) {
  const auto message = [](const auto& damage) {
    Camera camera = test::lens_camera(5);
    damage(camera);
    return [camera] { validate(camera, "left.yml: camera 0"); };
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message([](Camera& c) { c.width = 0; }),
              ThrowsMessage<DataError>(HasSubstr("left.yml: camera 0: the image size is 0x720")));
  EXPECT_THAT(message([](Camera& c) { c.fx = -700; }),
              ThrowsMessage<DataError>(HasSubstr("fx = -700")));
  EXPECT_THAT(message([&](Camera& c) { c.fy = nan; }),
              ThrowsMessage<DataError>(HasSubstr("fy = nan")));
  EXPECT_THAT(message([&](Camera& c) { c.cx = nan; }),
              ThrowsMessage<DataError>(HasSubstr("principal point")));
  EXPECT_THAT(message([](Camera& c) { c.distortion.resize(6); }),
              ThrowsMessage<DataError>(HasSubstr("6 distortion coefficients")));
  EXPECT_THAT(message([&](Camera& c) { c.distortion[2] = nan; }),
              ThrowsMessage<DataError>(HasSubstr("a distortion coefficient is nan")));
  EXPECT_THAT(message([](Camera& c) { c.distortion_model = DistortionModel::fisheye; }),
              ThrowsMessage<DataError>(HasSubstr("expected 4 (k1 k2 k3 k4)")));
  EXPECT_THAT(message([](Camera& c) { c.camera_from_world.linear()(0, 1) += 0.01; }),
              ThrowsMessage<DataError>(HasSubstr("R is no rotation")));
  EXPECT_THAT(message([](Camera& c) { c.camera_from_world.linear()(1, 1) = -1; }),
              ThrowsMessage<DataError>(HasSubstr("mirrored rotation (determinant -1)")));
  EXPECT_THAT(message([&](Camera& c) { c.camera_from_world.translation().x() = nan; }),
              ThrowsMessage<DataError>(HasSubstr("the pose holds NaN")));
}

TEST(Camera, ToleratesARotationWrittenWithFewDigits) {
  Camera camera = test::lens_camera(5);
  camera.camera_from_world.linear()(0, 1) += 4e-5;
  EXPECT_NO_THROW(validate(camera, "c"));
}

}  // namespace
}  // namespace hypotrack
