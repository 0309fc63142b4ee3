// Every reader of calibrations names the keys and sections that it does not use.

#include <gmock/gmock.h>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kPlainPair =
    R"(M1: {rows: 3, cols: 3, dt: d, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
D1: {rows: 1, cols: 5, dt: d, data: [0.1, 0, 0, 0, 0]}
M2: {rows: 3, cols: 3, dt: d, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
D2: {rows: 1, cols: 5, dt: d, data: [0.1, 0, 0, 0, 0]}
)";
constexpr const char* kPlainPose = R"(R: [1, 0, 0, 0, 1, 0, 0, 0, 1]
T: [-0.1, 0, 0]
)";
constexpr const char* kPlainCamera = R"(image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, dt: d, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
distortion_coefficients: {rows: 4, cols: 1, dt: d, data: [0.1, 0.01, 0, 0]}
avg_reprojection_error: 0.2
)";
constexpr const char* kPlainKalibr = R"(cam0:
  T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.2, 0.07, 0.0001, 0.0002]
  distortion_model: radtan
  intrinsics: [458, 457, 367, 248]
  resolution: [752, 480]
  rostopic: /cam0
cam1:
  T_cam_imu: [[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  distortion_coeffs: [-0.2, 0.07, 0.0001, 0.0002]
  distortion_model: radtan
  intrinsics: [458, 457, 367, 248]
  resolution: [752, 480]
)";
constexpr const char* kPlainList = R"(cameras:
  - {image_width: 640, image_height: 480, K: [500, 0, 320, 0, 500, 240, 0, 0, 1], model: none}
)";
constexpr const char* kPlainEuroc = R"(sensor_type: camera
T_BS: {cols: 4, rows: 4, data: [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.6, 457.3, 367.2, 248.4]
distortion_model: radial-tangential
distortion_coefficients: [-0.28, 0.07, 0.0002, 1.7e-05]
)";
constexpr const char* kPlainTables = R"([cameras.0]
cam_id = 0
size = [1280, 720]
matrix = [[900.0, 0.0, 620.0], [0.0, 905.0, 390.0], [0.0, 0.0, 1.0]]
distortions = [-0.3, 0.05, 0.0, 0.0, 0.07]
translation = [0.1, 0.0, 0.0]
rotation = [0.0, 0.5, 0.0]
ignore = false
rotation_count = 0
)";
constexpr const char* kPlainRos = R"(image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0.2, 0, 0, 0]}
roi: {x_offset: 0, y_offset: 0, width: 0, height: 0, do_rectify: false}
)";

class UnusedKeys : public test::CalibrationFiles {
 protected:
  std::vector<std::string> notes_on(const std::string& text) {
    return read_calibration(file("file", text)).notes;
  }
  auto names(const std::string& unknown) {
    return ElementsAre(AllOf(HasSubstr("file: not used: "), HasSubstr(unknown)));
  }
};

TEST_F(UnusedKeys, OfHypotracksOwnFormAreNamed) {
  EXPECT_THAT(notes_on(kPlainList), IsEmpty());
  EXPECT_THAT(notes_on(kPlainList + std::string("shutter: rolling\n")),
              names("shutter (not understood)"));
}

TEST_F(UnusedKeys, OfOpenCvPairsAreNamed) {
  EXPECT_THAT(notes_on(std::string(kPlainPair) + kPlainPose), IsEmpty());
  EXPECT_THAT(notes_on(std::string(kPlainPair) + kPlainPose + "Q: [1]\ntint1: [0.5]\n"),
              names("tint1 (not understood); Q (rectification, which follows from R and T)"));
  EXPECT_THAT(notes_on(with(kPlainPair, "dt: d,", "dt: d, units: px,") + std::string(kPlainPose)),
              names("M1.units (not understood)"));
  CalibrationSettings settings = file("file", std::string(kPlainPair) + kPlainPose);
  settings.extrinsics = write("pose", kPlainPose + std::string("P1: [1]\nrig: 4\n"));
  EXPECT_THAT(
      read_calibration(settings).notes,
      ElementsAre(HasSubstr("file: not used: R, T (`extrinsics` names another file)"),
                  AllOf(HasSubstr("pose: not used: rig (not understood); P1 (rectification"))));
}

TEST_F(UnusedKeys, OfOpenCvCamerasAreNamed) {
  EXPECT_THAT(notes_on(kPlainCamera), IsEmpty());
  EXPECT_THAT(notes_on(kPlainCamera + std::string("tint: 0.5\n")), names("tint (not understood)"));
  CalibrationSettings settings = file("file", kPlainCamera);
  settings.second = write("second", kPlainCamera + std::string("tint: 2\n"));
  settings.extrinsics = write("pose", kPlainPose + std::string("S: 1\n"));
  EXPECT_THAT(read_calibration(settings).notes,
              ElementsAre(HasSubstr("second: not used: tint"), HasSubstr("pose: not used: S")));
}

TEST_F(UnusedKeys, OfAnOmnidirectionalLensAreErrors) {
  const std::string pair = std::string(kPlainPair) + kPlainPose;
  for (const std::string& text :
       {kPlainCamera + std::string("xi: 0.5\n"), pair + "xi1: [0.5]\n", pair + "xi_2: 0.5\n"})
    EXPECT_THAT([&] { notes_on(text); }, testing::ThrowsMessage<DataError>(AllOf(
                                             HasSubstr("xi is of OpenCV's omnidirectional lens"),
                                             HasSubstr("calibrate with cv::fisheye"))))
        << text;
}

TEST_F(UnusedKeys, OfKalibrAreNamed) {
  EXPECT_THAT(notes_on(kPlainKalibr), IsEmpty());
  EXPECT_THAT(notes_on(with(kPlainKalibr, "  rostopic: /cam0\n", "  shutter: rolling\n")),
              names("cam0.shutter (not understood)"));
  const std::string chained =
      with(kPlainKalibr, "cam1:\n",
           "cam1:\n  timeshift_cam_imu: 0.01\n  T_cn_cnm1: [[1, 0, 0, -0.1], [0, 1, 0, 0], "
           "[0, 0, 1, 0], [0, 0, 0, 1]]\n");
  EXPECT_THAT(
      notes_on(chained + "imu0: {rate: 200}\ncam3: {a: 1}\n"),
      names(
          "imu0, cam3 (not understood); cam0.T_cam_imu, cam1.timeshift_cam_imu, cam1.T_cam_imu (of "
          "the IMU)"));
}

TEST_F(UnusedKeys, OfRosAreNamedAtEveryDepth) {
  EXPECT_THAT(notes_on(kPlainRos), IsEmpty());
  EXPECT_THAT(notes_on(with(kPlainRos, "width: 0,", "width: 0, depth: 3,")),
              names("roi.depth (not understood)"));
  EXPECT_THAT(notes_on(with(kPlainRos, "rows: 1,", "rows: 1, layers: 2,") +
                       "D: [1]\nshutter: {a: {b: 1}}\n"),
              names("distortion_coefficients.layers, shutter (not understood)"));
}

TEST_F(UnusedKeys, OfEurocAreNamedAndItsPairsHaveTheirPlacesOnTheBody) {
  EXPECT_THAT(notes_on(kPlainEuroc), IsEmpty());
  CalibrationSettings settings = file("file", kPlainEuroc + std::string("shutter: global\n"));
  settings.second = write("second", with(kPlainEuroc, "1, 0, 0, 0,", "1, 0, 0, 0.11,"));
  const auto found = read_calibration(settings);
  EXPECT_THAT(found.notes, names("shutter (not understood)"));
  ASSERT_EQ(found.cameras.size(), 2u);
  // Along the body's y, which is the cameras' x.
  EXPECT_TRUE(found.cameras[1].camera.camera_from_world.translation().isApprox(
      Eigen::Vector3d(-0.11, 0, 0), 1e-12));
  EXPECT_EQ(found.cameras[0].camera.distortion.size(), 4u);
  settings.second = write("second", kPlainKalibr);
  EXPECT_THAT(loading(settings),
              testing::ThrowsMessage<DataError>(HasSubstr("second: is no sensor.yaml")));
}

TEST_F(UnusedKeys, OfTablesOfCamerasAreNamed) {
  EXPECT_THAT(notes_on(kPlainTables), IsEmpty());
  EXPECT_THAT(notes_on(kPlainTables + std::string("[charuco]\ncolumns = 4\n")),
              names("charuco (not understood)"));
  EXPECT_THAT(notes_on(with(kPlainTables, "cam_id", "colour = 3\ncam_id")),
              names("cameras.0.colour (not understood)"));
  EXPECT_THAT(notes_on(with(with(kPlainTables, "ignore = false", "ignore = true"), "count = 0",
                            "count = 1")),
              names("cameras.0.ignore, cameras.0.rotation_count (of the recording program)"));
}

TEST_F(UnusedKeys, AreCutIfThereAreVeryMany) {
  std::string text = kPlainList;
  for (int i = 0; i < 200; ++i) text += "k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(notes_on(text), names("k23 and 176 more (not understood)"));
  for (int i = 200; i < 5000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(notes_on(text), names("5001 keys (not understood)"));
  for (int i = 5000; i < 11'000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(loading(file("file", text)),
              testing::ThrowsMessage<DataError>(HasSubstr("it has 11001 keys")));
}

TEST_F(UnusedKeys, FilesThatSettingsNameInVainAreNamed) {
  CalibrationSettings settings = file("file", kPlainKalibr);
  settings.second = write("second", kPlainKalibr);
  settings.extrinsics = write("pose", kPlainPose);
  EXPECT_THAT(
      read_calibration(settings).notes,
      ElementsAre(HasSubstr("second: not read: `second` is of no use with a file of Kalibr"),
                  HasSubstr("pose: not read: `extrinsics` is of no use")));
}

TEST_F(UnusedKeys, ALensModelThatTheFileContradictsIsNamed) {
  CalibrationSettings settings = file("file", kPlainKalibr);
  settings.model = DistortionModel::fisheye;
  EXPECT_THAT(
      read_calibration(settings).notes,
      ElementsAre(HasSubstr("file: `model: fisheye` is not used for camera cam0: the file's "
                            "lens is brown"),
                  HasSubstr("camera cam1")));
}

TEST_F(UnusedKeys, MissingLensesOfOpenCvAreNamed) {
  EXPECT_THAT(
      notes_on(with(kPlainPair, "D2: {rows: 1, cols: 5, dt: d, data: [0.1, 0, 0, 0, 0]}", "") +
               kPlainPose),
      ElementsAre(HasSubstr("has no D2; no distortion is taken for it")));
  EXPECT_THAT(notes_on(with(kPlainCamera, "distortion_coefficients", "lens")),
              ElementsAre(HasSubstr("has no distortion_coefficients; no distortion"),
                          HasSubstr("file: not used: lens (not understood)")));
}

TEST_F(UnusedKeys, FisheyeModelOfOpenCvIsHonoured) {
  EXPECT_EQ(load_calibration(file("file", kPlainCamera + std::string("fisheye_model: 1\n")))[0]
                .distortion_model,
            DistortionModel::fisheye);
  EXPECT_EQ(load_calibration(file("file", kPlainCamera + std::string("fisheye_model: 0\n")))[0]
                .distortion_model,
            DistortionModel::brown);
}

}  // namespace
}  // namespace hypotrack
