// Settings of ORB-SLAM 2 and 3.

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

constexpr const char* kOrbPair = R"(%YAML:1.0

File.version: "1.0"
Camera.type: "PinHole"
Camera1.fx: 458.654
Camera1.fy: 457.296
Camera1.cx: 367.215
Camera1.cy: 248.375
Camera1.k1: -0.28340811
Camera1.k2: 0.07395907
Camera1.p1: 0.00019359
Camera1.p2: 1.76187114e-05
Camera2.fx: 457.587
Camera2.fy: 456.134
Camera2.cx: 379.999
Camera2.cy: 255.238
Camera2.k1: -0.28368365
Camera2.k2: 0.07451284
Camera2.p1: -0.00010473
Camera2.p2: -3.55590700e-05
Camera2.k3: 0.
Camera.width: 752
Camera.height: 480
Camera.fps: 20
Stereo.ThDepth: 60.0
Stereo.T_c1_c2: !!opencv-matrix
  rows: 4
  cols: 4
  dt: f
  data: [0.995004165, -0.099833417, 0, 0.110078,
         0.099833417, 0.995004165, 0, -0.000157,
         0, 0, 1, 0.000889,
         0, 0, 0, 1.0]
ORBextractor.nFeatures: 1200
Viewer.PointSize:2
)";
constexpr const char* kOrbOlder = R"(%YAML:1.0

Camera.type: "PinHole"
Camera.fx: 435.2
Camera.fy: 435.2
Camera.cx: 367.45
Camera.cy: 252.2
Camera.k1: 0.0
Camera.k2: 0.0
Camera.p1: 0.0
Camera.p2: 0.0
Camera.bFishEye: 0
Camera.width: 752
Camera.height: 480
Camera.fps: 20.0
Camera.bf: 47.872
ThDepth: 35
)";
constexpr const char* kOrbRaw = R"(LEFT.height: 480
LEFT.width: 752
LEFT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.0]
LEFT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [458.654, 0.0, 367.215, 0.0, 457.296, 248.375, 0.0, 0.0, 1.0]
LEFT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
LEFT.P:  !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [435.2, 0, 367.45, 0,  0, 435.2, 252.2, 0,  0, 0, 1, 0]
RIGHT.height: 480
RIGHT.width: 752
RIGHT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28368365, 0.07451284, -0.00010473, -3.555907e-05, 0.0]
RIGHT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [457.587, 0.0, 379.999, 0.0, 456.134, 255.238, 0.0, 0.0, 1]
RIGHT.R:  !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0.995004165, -0.099833417, 0, 0.099833417, 0.995004165, 0, 0, 0, 1]
RIGHT.P:  !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [435.2, 0, 367.45, -47.872, 0, 435.2, 252.2, 0, 0, 0, 1, 0]
)";

class OrbSlamCalibration : public test::CalibrationFiles {
 protected:
  std::vector<Camera> load(const std::string& text) {
    return load_calibration(file("settings.yaml", text));
  }
  std::vector<std::string> notes_on(const std::string& text) {
    return read_calibration(file("settings.yaml", text)).notes;
  }
};

TEST_F(OrbSlamCalibration, APairHasThePoseOfItsSecondCameraInTheFirst) {
  const std::vector<Camera> cameras = load(kOrbPair);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].width, 752);
  EXPECT_EQ(cameras[1].fy, 456.134);
  EXPECT_THAT(cameras[0].distortion,
              ElementsAre(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05));
  EXPECT_EQ(cameras[1].distortion.size(), 5u);
  const Eigen::Isometry3d first_from_second = cameras[1].camera_from_world.inverse();
  EXPECT_TRUE(first_from_second.translation().isApprox(
      Eigen::Vector3d(0.110078, -0.000157, 0.000889), 1e-9));
  EXPECT_NEAR(Eigen::AngleAxisd(first_from_second.linear()).angle(), 0.1, 1e-6);
  EXPECT_THAT(notes_on(kOrbPair), IsEmpty());
}

TEST_F(OrbSlamCalibration, KannalaBrandt8IsAFisheyeLens) {
  std::string text = with(with(kOrbPair, "PinHole", "KannalaBrandt8"), "Camera1.p1", "Camera1.k3");
  text = with(with(text, "Camera1.p2", "Camera1.k4"), "Camera2.p1", "Camera2.k4");
  const std::vector<Camera> cameras = load(text);
  EXPECT_EQ(cameras[0].distortion_model, DistortionModel::fisheye);
  EXPECT_THAT(cameras[0].distortion,
              ElementsAre(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05));
  EXPECT_THAT(cameras[1].distortion, ElementsAre(-0.28368365, 0.07451284, 0, -0.00010473));
  EXPECT_THAT(notes_on(text), ElementsAre(HasSubstr("Camera2.p2 (not understood)")));
  EXPECT_THAT(loading(file("a.yaml", with(kOrbPair, "PinHole", "KannalaBrandt8"))),
              ThrowsMessage<DataError>(HasSubstr("has no Camera1.k3")));
  EXPECT_THAT(loading(file("a.yaml", with(kOrbPair, "PinHole", "Omni"))),
              ThrowsMessage<DataError>(HasSubstr("expected one of PinHole, KannalaBrandt8, Rect")));
}

TEST_F(OrbSlamCalibration, OlderFisheyePairsHaveTlr) {
  std::string text = with(kOrbPair, "Stereo.T_c1_c2", "Tlr");
  text = with(with(text, "rows: 4", "rows: 3"), "0.000889,\n         0, 0, 0, 1.0]", "0.000889]");
  for (const char* key : {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"})
    text = with(text, std::string("Camera1.") + key, std::string("Camera.") + key);
  EXPECT_NEAR(load(text)[1].camera_from_world.inverse().translation().x(), 0.110078, 1e-9);
  EXPECT_THAT(loading(file("a.yaml", with(text, "Tlr", "Trl"))),
              ThrowsMessage<DataError>(HasSubstr("has Camera2, and no Stereo.T_c1_c2 (or Tlr)")));
}

TEST_F(OrbSlamCalibration, RectifiedPairsHaveOneCameraAndABaseline) {
  const std::string text = R"(%YAML:1.0
File.version: "1.0"
Camera.type: "Rectified"
Camera1.fx: 382.613
Camera1.fy: 382.613
Camera1.cx: 320.183
Camera1.cy: 236.455
Stereo.b: 0.0499585
Camera.width: 640
Camera.height: 480
IMU.NoiseGyro: 1e-3 # rad/s^0.5
)";
  const std::vector<Camera> cameras = load(text);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1].fx, 382.613);
  EXPECT_EQ(cameras[1].distortion_model, DistortionModel::none);
  EXPECT_EQ(cameras[1].camera_from_world.translation(), Eigen::Vector3d(-0.0499585, 0, 0));
  EXPECT_THAT(notes_on(text), ElementsAre(HasSubstr("IMU.NoiseGyro (of the IMU)")));
  const std::string own =
      "Camera2.fx: 382.613\nCamera2.fy: 382.613\nCamera2.cx: 321\nCamera2.cy: 236.455\nStereo.b";
  EXPECT_EQ(load(with(text, "Stereo.b", own))[1].cx, 321);
  EXPECT_THAT(loading(file("a.yaml", with(text, "Stereo.b", "Stereo.c"))),
              ThrowsMessage<DataError>(HasSubstr("has no Stereo.b")));
}

TEST_F(OrbSlamCalibration, OlderPairsHaveTheBaselineTimesTheFocalLength) {
  const std::vector<Camera> cameras = load(kOrbOlder);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_NEAR(cameras[1].camera_from_world.translation().x(), -0.11, 1e-12);
  EXPECT_THAT(notes_on(kOrbOlder), IsEmpty());
}

TEST_F(OrbSlamCalibration, LeftAndRightAreCamerasBeforeRectification) {
  const std::string text = std::string(kOrbOlder) + kOrbRaw;
  const std::vector<Camera> cameras = load(text);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].fx, 458.654);
  EXPECT_EQ(cameras[1].cx, 379.999);
  EXPECT_EQ(cameras[1].distortion.size(), 5u);
  // 0.11 m along x of the rectified frame, which is the left camera's.
  EXPECT_TRUE(cameras[1].camera_from_world.inverse().translation().isApprox(
      Eigen::Vector3d(0.11, 0, 0), 1e-9));
  EXPECT_NEAR(Eigen::AngleAxisd(cameras[1].camera_from_world.linear()).angle(), 0.1, 1e-6);
  EXPECT_THAT(notes_on(text), Contains(HasSubstr("LEFT and RIGHT are read, the cameras of pictures "
                                                 "before rectification")));
}

TEST_F(OrbSlamCalibration, LeftAndRightOfAnotherFileAreNotUsed) {
  const std::string text = with(kOrbOlder, "Camera.fx: 435.2", "Camera.fx: 859.04") + kOrbRaw;
  EXPECT_EQ(load(text)[0].fx, 859.04);
  EXPECT_THAT(notes_on(text), ElementsAre(HasSubstr("(LEFT and RIGHT do not lead to Camera.fx")));
}

TEST_F(OrbSlamCalibration, CamerasWithDepthAreOne) {
  const std::string text = kOrbOlder + std::string("DepthMapFactor: 5000.0\n");
  EXPECT_EQ(load(text).size(), 1u);
  EXPECT_THAT(
      notes_on(text),
      ElementsAre(AllOf(HasSubstr("Camera.bf (no baseline: the file is of one camera"),
                        HasSubstr("DepthMapFactor (one camera with depth: `depth_factor`"))));
}

TEST_F(OrbSlamCalibration, WhatIsNotUsedIsNamed) {
  EXPECT_THAT(
      notes_on(kOrbPair + std::string("Camera1.k7: 0.1\nShutter: 1\nCamera.newWidth: 600\n")),
      ElementsAre(AllOf(HasSubstr("Camera1.k7, Shutter (not understood)"),
                        HasSubstr("Camera.newWidth (ORB-SLAM makes pictures smaller"))));
  EXPECT_THAT(notes_on(with(kOrbOlder, "bFishEye: 0", "bFishEye: 1")),
              ElementsAre(HasSubstr("Camera.bFishEye (not understood)")));
}

TEST_F(OrbSlamCalibration, BrokenNumbersAreLocated) {
  EXPECT_THAT(loading(file("a.yaml", with(kOrbPair, "458.654", "wide"))),
              ThrowsMessage<DataError>(AllOf(HasSubstr("a.yaml:5"), HasSubstr("'wide'"))));
  EXPECT_THAT(loading(file("a.yaml", with(kOrbPair, "Camera.height: 480\n", ""))),
              ThrowsMessage<DataError>(HasSubstr("has no Camera.height")));
  EXPECT_THAT(loading(file("a.yaml", with(kOrbPair, "0, 0, 0, 1.0]", "0, 0, 1, 1.0]"))),
              ThrowsMessage<DataError>(HasSubstr("another last row than 0 0 0 1")));
}

}  // namespace
}  // namespace hypotrack
