#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <random>

#include "hypotrack/api/calibration.hpp"
#include "output/recording/recording_writer.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

Camera random_camera(DistortionModel model, std::size_t coefficients, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 500 + unit(random);
  camera.fy = 500 + unit(random);
  camera.cx = 320 + unit(random);
  camera.cy = 240 + unit(random);
  camera.distortion_model = model;
  for (std::size_t i = 0; i < coefficients; ++i) camera.distortion.push_back(0.01 * unit(random));
  const Eigen::Vector3d axis(unit(random), unit(random), unit(random));
  camera.camera_from_world.linear() =
      Eigen::AngleAxisd(0.3 * unit(random), axis.normalized()).toRotationMatrix();
  camera.camera_from_world.translation() << unit(random), unit(random), unit(random);
  camera.camera_from_world.translation() *= 0.1;
  return camera;
}

TEST(CalibrationYaml, ReadsBackToTheSameCameras) {
  const test::TemporaryDirectory folder;
  CalibrationSettings settings;
  settings.file = folder.path() / "calibration.yaml";
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    const std::vector<Camera> written = {random_camera(DistortionModel::none, 0, random),
                                         random_camera(DistortionModel::brown, 5, random),
                                         random_camera(DistortionModel::brown, 8, random),
                                         random_camera(DistortionModel::fisheye, 4, random)};
    std::ofstream(settings.file) << calibration_yaml(written);
    const std::vector<Camera> read = load_calibration(settings);
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].width, written[i].width);
      EXPECT_EQ(read[i].height, written[i].height);
      EXPECT_EQ(read[i].fx, written[i].fx);
      EXPECT_EQ(read[i].fy, written[i].fy);
      EXPECT_EQ(read[i].cx, written[i].cx);
      EXPECT_EQ(read[i].cy, written[i].cy);
      EXPECT_EQ(read[i].distortion_model, written[i].distortion_model);
      EXPECT_EQ(read[i].distortion, written[i].distortion);
      EXPECT_EQ(read[i].camera_from_world.translation(),
                written[i].camera_from_world.translation());
      // The reader makes every R the nearest rotation, which costs the last digit.
      EXPECT_LT((read[i].camera_from_world.linear() - written[i].camera_from_world.linear())
                    .cwiseAbs()
                    .maxCoeff(),
                2e-15);
    }
  }
}

}  // namespace
}  // namespace hypotrack
