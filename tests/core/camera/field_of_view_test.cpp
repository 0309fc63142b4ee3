#include "camera/lens/field_of_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace hypotrack {
namespace {

Camera seeing_camera(DistortionModel model, std::vector<double> distortion) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.distortion_model = model;
  camera.distortion = std::move(distortion);
  return camera;
}

double in_degrees(double radians) { return radians * 180 / std::numbers::pi; }

TEST(FieldOfViewOfCameras, ReachesFromEdgeToEdge) {
  Camera camera = seeing_camera(DistortionModel::none, {});
  const FieldOfView centred = field_of_view(camera);
  EXPECT_NEAR(centred.horizontal, 2 * std::atan(320 / 500.0), 1e-9);
  EXPECT_NEAR(centred.vertical, 2 * std::atan(240 / 500.0), 1e-9);
  EXPECT_TRUE(centred.reaches_edges);
  camera.cx = -100.5;  // both edges are on one side of it
  EXPECT_NEAR(field_of_view(camera).horizontal, std::atan(740 / 500.0) - std::atan(100 / 500.0),
              1e-9);
}

TEST(FieldOfViewOfCameras, FollowsTheLens) {
  // A ZED at 1280 x 720: barrel distortion lets it see more than its focal length says.
  Camera zed = seeing_camera(DistortionModel::brown, {-0.175995, 0.0265533, 0, 0, 0});
  zed.width = 1280;
  zed.height = 720;
  zed.fx = zed.fy = 700.895;
  zed.cx = 665.54;
  zed.cy = 371.155;
  EXPECT_NEAR(in_degrees(field_of_view(zed).horizontal), 95.8601, 1e-3);
  EXPECT_NEAR(in_degrees(field_of_view(zed).vertical), 56.7463, 1e-3);
  const Camera fisheye = seeing_camera(DistortionModel::fisheye, {0, 0, 0, 0});
  EXPECT_NEAR(field_of_view(fisheye).horizontal, 2 * 320 / 500.0, 1e-9);
}

TEST(FieldOfViewOfCameras, IsThatInsideThePictureWhereALensTurnsRaysBackFarOutside) {
  // Of an OAK camera: the tangential terms win at 89 degrees.
  const Camera oak = seeing_camera(DistortionModel::brown, {15.6827, -81.9808, 0.001852, -0.0025135,
                                                            135.1396, 15.1328, -79.1491, 130.745});
  const FieldOfView seen = field_of_view(oak);
  EXPECT_TRUE(seen.reaches_edges);
  EXPECT_NEAR(in_degrees(seen.horizontal), in_degrees(2 * std::atan(320 / 500.0)), 1);
}

TEST(FieldOfViewOfCameras, EndsWhereTheLensFolds) {
  const FieldOfView seen = field_of_view(seeing_camera(DistortionModel::brown, {-1.2, 0, 0, 0}));
  EXPECT_FALSE(seen.reaches_edges);
  EXPECT_NEAR(in_degrees(seen.horizontal), 55.617, 0.01);
}

}  // namespace
}  // namespace hypotrack
