// Calibrations of OAK cameras, as depthai exports them.

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

// The left camera stands 7.5 cm beside the right one, which is turned by 0.1 about z against the
// colour camera.
constexpr const char* kBoard = R"({
  "batchTime": 1656743259, "boardName": "DM9098", "productName": "OAK-D", "version": 7,
  "cameraData": [
    [2, {"cameraType": 0, "width": 1280, "height": 800, "lensPosition": 0, "specHfovDeg": 71.86,
      "distortionCoeff": [0.2, -0.1, 0.001, -0.002, 0.01, 0.3, 0.05, 0.02, 0.0, 0.0, 0.0, 0.0, -0.024, 0.005],
      "extrinsics": {"rotationMatrix": [[0.995004165, -0.099833417, 0.0], [0.099833417, 0.995004165, 0.0], [0.0, 0.0, 1.0]],
        "specTranslation": {"x": 3.75, "y": 0.0, "z": 0.0}, "toCameraSocket": 0,
        "translation": {"x": 3.8, "y": 0.1, "z": 0.0}},
      "intrinsicMatrix": [[802.0, 0.0, 641.0], [0.0, 803.0, 401.0], [0.0, 0.0, 1.0]]}],
    [0, {"cameraType": 0, "width": 1920, "height": 1080, "lensPosition": 135, "specHfovDeg": 68.8,
      "distortionCoeff": [0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
      "extrinsics": {"rotationMatrix": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        "specTranslation": {"x": 0.0, "y": 0.0, "z": 0.0}, "toCameraSocket": -1,
        "translation": {"x": 0.0, "y": 0.0, "z": 0.0}},
      "intrinsicMatrix": [[1577.0, 0.0, 987.0], [0.0, 1575.0, 552.0], [0.0, 0.0, 1.0]]}],
    [1, {"cameraType": 0, "width": 1280, "height": 800, "lensPosition": 0, "specHfovDeg": 71.86,
      "distortionCoeff": [0.21, -0.1, 0.001, -0.002, 0.01, 0.3, 0.05, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
      "extrinsics": {"rotationMatrix": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "specTranslation": {"x": -7.5, "y": 0.0, "z": 0.0}, "toCameraSocket": 2,
        "translation": {"x": -7.52, "y": 0.04, "z": -0.03}},
      "intrinsicMatrix": [[801.0, 0.0, 647.0], [0.0, 799.0, 414.0], [0.0, 0.0, 1.0]]}]
  ],
  "imuExtrinsics": {"toCameraSocket": -1},
  "miscellaneousData": [],
  "stereoRectificationData": {"leftCameraSocket": 1, "rightCameraSocket": 2,
    "rectifiedRotationLeft": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "rectifiedRotationRight": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}
})";

class DepthAiCalibration : public test::CalibrationFiles {
 protected:
  /// Reads the cameras of a board, in an order of their names.
  hypotrack::Calibration read(const std::string& text, std::vector<std::string> cameras = {}) {
    CalibrationSettings settings = file("calib.json", text);
    settings.cameras = std::move(cameras);
    return read_calibration(settings);
  }
};

TEST_F(DepthAiCalibration, TheStereoPairIsRead) {
  const auto found = read(kBoard);
  EXPECT_EQ(found.format, "depthai (OAK)");
  ASSERT_EQ(found.cameras.size(), 2u);
  EXPECT_EQ(found.cameras[0].name, "left");
  EXPECT_EQ(found.cameras[1].name, "right");
  const Camera &left = found.cameras[0].camera, &right = found.cameras[1].camera;
  EXPECT_EQ(left.width, 1280);
  EXPECT_EQ(left.height, 800);
  EXPECT_EQ(left.fy, 799);
  EXPECT_EQ(right.cx, 641);
  EXPECT_THAT(left.distortion, ElementsAre(0.21, -0.1, 0.001, -0.002, 0.01, 0.3, 0.05, 0.02));
  EXPECT_THAT(right.distortion, ElementsAre(0.2, -0.1, 0.001, -0.002, 0.01, 0.3, 0.05, 0.02, 0, 0,
                                            0, 0, -0.024, 0.005));
  EXPECT_TRUE(left.camera_from_world.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(right.camera_from_world.translation().isApprox(
      Eigen::Vector3d(-0.0752, 0.0004, -0.0003), 1e-9));
  EXPECT_TRUE(right.camera_from_world.linear().isIdentity(1e-9));
}

TEST_F(DepthAiCalibration, CamerasAreChosenByNameAlongTheChainOfPoses) {
  const auto found = read(kBoard, {"CAM_A", "CAM_B"});
  ASSERT_EQ(found.cameras.size(), 2u);
  EXPECT_EQ(found.cameras[0].camera.width, 1920);
  // p_colour = Rz(0.1) (p_left + (-7.52, 0.04, -0.03)) + (3.8, 0.1, 0), in centimetres.
  const Eigen::Isometry3d colour_from_left = found.cameras[1].camera.camera_from_world.inverse();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).matrix();
  EXPECT_TRUE(colour_from_left.linear().isApprox(turn, 1e-6));
  const Eigen::Vector3d expected =
      0.01 * (turn * Eigen::Vector3d(-7.52, 0.04, -0.03) + Eigen::Vector3d(3.8, 0.1, 0));
  EXPECT_TRUE(colour_from_left.translation().isApprox(expected, 1e-6));
  EXPECT_EQ(read(kBoard, {"rgb"}).cameras.size(), 1u);
  EXPECT_THAT(
      [&] { read(kBoard, {"CAM_D"}); },
      ThrowsMessage<DataError>(HasSubstr("no camera 'CAM_D'; expected CAM_A, left, right")));
}

TEST_F(DepthAiCalibration, SocketsMayHaveNamesAndCamerasKeys) {
  std::string text = with(kBoard, "[2, {", "[\"CAM_C\", {");
  text = with(with(text, "[1, {", "[\"LEFT\", {"), "\"toCameraSocket\": 2",
              "\"toCameraSocket\": \"CAM_C\"");
  text = with(text, "\"leftCameraSocket\": 1", "\"leftCameraSocket\": 255");
  EXPECT_NEAR(read(text).cameras[1].camera.camera_from_world.translation().x(), -0.0752, 1e-9);
  const auto one = read(R"({"cameraData": {"CAM_A": {"width": 640, "height": 480,
    "intrinsicMatrix": [[500, 0, 320], [0, 500, 240], [0, 0, 1]],
    "distortionCoeff": [0.1, 0.01, 0, 0]}}})");
  ASSERT_EQ(one.cameras.size(), 1u);
  EXPECT_EQ(one.cameras[0].name, "CAM_A");
  EXPECT_THAT([&] { read(with(kBoard, "[2, {", "[\"CAM_Z\", {")); },
              ThrowsMessage<DataError>(HasSubstr("socket is 'CAM_Z'; expected -1 to 9, or CAM_A")));
}

TEST_F(DepthAiCalibration, TheFileSaysWhichSocketsAreLeftAndRight) {
  const auto found = read(with(with(kBoard, "\"leftCameraSocket\": 1", "\"leftCameraSocket\": 2"),
                               "\"rightCameraSocket\": 2", "\"rightCameraSocket\": 1"));
  EXPECT_EQ(found.cameras[0].name, "left");
  EXPECT_EQ(found.cameras[0].camera.fx, 802);
  EXPECT_GT(found.cameras[1].camera.camera_from_world.translation().x(), 0.07);
}

TEST_F(DepthAiCalibration, FisheyeLensesHaveFourOfFourteenNumbers) {
  std::string text = with(kBoard, "[2, {\"cameraType\": 0", "[2, {\"cameraType\": 1");
  EXPECT_THAT([&] { read(text); }, ThrowsMessage<DataError>(HasSubstr("expected 4, or zeros")));
  text = with(text, "0.01, 0.3, 0.05, 0.02, 0.0, 0.0, 0.0, 0.0, -0.024, 0.005]",
              "0, 0, 0, 0, 0, 0, 0, 0, 0, 0]");
  const Camera right = read(text).cameras[1].camera;
  EXPECT_EQ(right.distortion_model, DistortionModel::fisheye);
  EXPECT_THAT(right.distortion, ElementsAre(0.2, -0.1, 0.001, -0.002));
  EXPECT_THAT([&] { read(with(kBoard, "\"cameraType\": 0", "\"cameraType\": 3")); },
              ThrowsMessage<DataError>(HasSubstr("cameraType is '3'; expected one of")));
}

TEST_F(DepthAiCalibration, MissingLensesAndPosesAreErrors) {
  const std::string no_lens = with(
      kBoard, "[0.21, -0.1, 0.001, -0.002, 0.01, 0.3, 0.05, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]",
      "[]");
  EXPECT_THAT(
      [&] { read(no_lens); },
      ThrowsMessage<DataError>(AllOf(HasSubstr("calib.json:"), HasSubstr("no distortionCoeff"))));
  const std::string no_pose = with(kBoard,
                                   "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],\n        "
                                   "\"specTranslation\": {\"x\": -7.5",
                                   "[],\n        \"specTranslation\": {\"x\": -7.5");
  EXPECT_THAT(
      [&] { read(no_pose); },
      ThrowsMessage<DataError>(HasSubstr("no chain of extrinsics leads from left to right")));
  EXPECT_THAT([&] { read("{\"cameraData\": []}"); },
              ThrowsMessage<DataError>(HasSubstr("the board is not calibrated")));
  EXPECT_THAT([&] { read(with(kBoard, "\"x\": -7.52", "\"x\": \"far\"")); },
              ThrowsMessage<DataError>(HasSubstr("translation holds 'far'")));
}

TEST_F(DepthAiCalibration, TheDrawingReplacesAMissingTranslation) {
  const std::string text = with(kBoard, "{\"x\": -7.52, \"y\": 0.04, \"z\": -0.03}",
                                "{\"x\": 0.0, \"y\": 0.0, \"z\": 0.0}");
  const auto found = read(text);
  EXPECT_NEAR(found.cameras[1].camera.camera_from_world.translation().x(), -0.075, 1e-12);
  EXPECT_THAT(found.notes, Contains(HasSubstr("specTranslation, that of the drawing, is taken")));
  EXPECT_THAT(read(with(kBoard, "\"x\": -7.52", "\"x\": -8.446")).notes,
              Contains(HasSubstr("8.446 cm apart by calibration, which is taken, and 7.5 cm")));
}

TEST_F(DepthAiCalibration, WhatIsNotUsedIsNamed) {
  std::string text = with(kBoard, "\"version\": 7", "\"version\": 8, \"news\": 1");
  text = with(text, "[1, {", "[1, {\"shutter\": 1, ");
  EXPECT_THAT(
      read(text).notes,
      ElementsAre(
          HasSubstr("version 8 is newer"),
          AllOf(HasSubstr("calib.json: not used: news, cameraData.2.1.shutter (not understood)"),
                HasSubstr("cameraData.1.1 (of other cameras, which `cameras` chooses)"),
                HasSubstr("stereoRectificationData.rectifiedRotationLeft"),
                HasSubstr("imuExtrinsics, miscellaneousData (of the IMU"),
                Not(HasSubstr("batch")))));
}

}  // namespace
}  // namespace hypotrack
