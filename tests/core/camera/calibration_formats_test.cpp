// Calibration files of other programs.

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kKalibr = R"(cam0:
  T_imu_cam: [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  distortion_coeffs: [-0.2, 0.07, 0.0001, 0.0002]
  distortion_model: radtan
  intrinsics: [458, 457, 367, 248]
  resolution: [752, 480]
cam1:
  T_imu_cam: [[0, -1, 0, 0], [1, 0, 0, 0.11], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]
  distortion_model: equidistant
  intrinsics: [459, 460, 380, 255]
  resolution: [752, 480]
)";
constexpr const char* kZed = R"([LEFT_CAM_HD]
fx=700
fy=701
cx=640
cy=360
k1=-0.17
k2=0.02

[RIGHT_CAM_HD]
fx=699
fy=699
cx=639
cy=375
k1=-0.18
k2=0.03
p1=0.001
p2=0.002
k3=0.003

[LEFT_CAM_VGA]
fx=350
fy=350
cx=336
cy=188
k1=-0.17
k2=0.02

[RIGHT_CAM_VGA]
fx=349
fy=349
cx=335
cy=187
k1=-0.18
k2=0.03

[STEREO]
Baseline=120
TY=0.5
TZ=-0.25
CV_HD=0.01
RX_HD=0.002
RZ_HD=-0.003
)";
constexpr const char* kTables = R"(# a rig
[cameras.0]
cam_id = 0
size = [1280, 720]
matrix = [[900.0, 0.0, 620.0], [0.0, 905.0, 390.0], [0.0, 0.0, 1.0]]
distortions = [-0.3, 0.05, 0.0, 0.0, 0.07]
translation = [0.1, 0.0, 0.0]
rotation = [0.0, 0.5, 0.0]

[cameras.3]
cam_id = 3
fisheye = true
size = [640, 480]
matrix = [[600.0, 0.0, 320.0], [0.0, 605.0, 240.0], [0.0, 0.0, 1.0]]
distortions = [0.1, 0.2, 0.3, 0.4]
translation = [-0.1, 0.0, 0.0]
rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]

[metadata]
error = 0.3
)";

/// Returns a camera_info of ROS for a camera that is rectified by a turn of `angle` about y.
std::string ros(double angle, double offset_px) {
  const double c = std::cos(angle), s = std::sin(angle);
  std::ostringstream out;
  out.precision(17);
  out << "image_width: 640\nimage_height: 480\ncamera_name: cam\n"
      << "camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 501, 240, 0, 0, 1]}\n"
      << "distortion_model: plumb_bob\n"
      << "distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0.2, 0.003, 0.004, 0]}\n"
      << "rectification_matrix: {rows: 3, cols: 3, data: [" << c << ", 0, " << s << ", 0, 1, 0, "
      << -s << ", 0, " << c << "]}\n"
      << "projection_matrix: {rows: 3, cols: 4, data: [480, 0, 330, " << offset_px
      << ", 0, 480, 240, 0, 0, 0, 1, 0]}\n";
  return out.str();
}

class CalibrationFormats : public test::CalibrationFiles {};

TEST_F(CalibrationFormats, KalibrTakesPosesFromTheImuWhereThereIsNoChain) {
  const std::vector<Camera> cameras = load_calibration(file("camchain.yaml", kKalibr));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].distortion_model, DistortionModel::brown);
  EXPECT_EQ(cameras[1].distortion_model, DistortionModel::fisheye);
  EXPECT_EQ(cameras[1].width, 752);
  EXPECT_EQ(cameras[1].cy, 255);
  // Along the IMU's y, which is the cameras' x.
  EXPECT_TRUE(cameras[1].camera_from_world.translation().isApprox(Eigen::Vector3d(-0.11, 0, 0)));
  EXPECT_TRUE(cameras[1].camera_from_world.linear().isIdentity(1e-9));
}

TEST_F(CalibrationFormats, KalibrPrefersTheChain) {
  const std::string chain =
      "cam1:\n  T_cn_cnm1: [[1, 0, 0, -0.2], [0, 1, 0, 0.01], [0, 0, 1, 0], "
      "[0, 0, 0, 1]]\n";
  const std::vector<Camera> cameras =
      load_calibration(file("camchain.yaml", with(kKalibr, "cam1:\n", chain)));
  EXPECT_TRUE(cameras[1].camera_from_world.translation().isApprox(Eigen::Vector3d(-0.2, 0.01, 0)));
}

TEST_F(CalibrationFormats, KalibrSaysWhatIsMissing) {
  EXPECT_THAT(loading(file("a.yaml", with(kKalibr, "T_imu_cam", "T_other"))),
              ThrowsMessage<DataError>(AllOf(HasSubstr("a.yaml:9"), HasSubstr("no T_cn_cnm1"))));
  EXPECT_THAT(loading(file("a.yaml", with(kKalibr, "pinhole", "omni"))),
              ThrowsMessage<DataError>(HasSubstr("the camera model is 'omni'; expected pinhole")));
  EXPECT_THAT(loading(file("a.yaml", with(kKalibr, "radtan", "fov"))),
              ThrowsMessage<DataError>(HasSubstr("expected one of none, radtan, equidistant")));
  EXPECT_THAT(loading(file("a.yaml", with(kKalibr, "[458, 457,", "[458, "))),
              ThrowsMessage<DataError>(HasSubstr("intrinsics is 1 x 3; expected 1 x 4")));
  EXPECT_THAT(loading(file("a.yaml", with(kKalibr, "[[0, -1, 0, 0]", "[[0, -2, 0, 0]"))),
              ThrowsMessage<DataError>(HasSubstr("T_imu_cam: R is no rotation")));
}

TEST_F(CalibrationFormats, ZedHasCamerasForTheSizeOfThePictures) {
  const CalibrationSettings settings = file("SN1.conf", kZed);
  const std::vector<Camera> cameras = load_calibration(settings, {1280, 720});
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].fx, 700);
  EXPECT_EQ(cameras[1].distortion, (std::vector<double>{-0.18, 0.03, 0.001, 0.002, 0.003}));
  EXPECT_TRUE(cameras[1].camera_from_world.translation().isApprox(
      Eigen::Vector3d(-0.12, 0.0005, -0.00025)));
  const Eigen::AngleAxisd turn(cameras[1].camera_from_world.linear());
  EXPECT_TRUE((turn.angle() * turn.axis()).isApprox(Eigen::Vector3d(0.002, 0.01, -0.003)));
  EXPECT_EQ(load_calibration(settings, {672, 376})[0].fx, 350);
  CalibrationSettings chosen = settings;
  chosen.image_size = {672, 376};
  EXPECT_EQ(load_calibration(chosen)[0].width, 672);
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(AllOf(HasSubstr("1280 x 720, 672 x 376"),
                                                                HasSubstr("image_size"))));
  EXPECT_THAT(loading(settings, {1920, 1080}),
              ThrowsMessage<DataError>(HasSubstr("no cameras for pictures of 1920 x 1080")));
  EXPECT_THAT(loading(file("b.conf", with(kZed, "fx=700", "f=700")), {1280, 720}),
              ThrowsMessage<DataError>(HasSubstr("has no fx")));
  EXPECT_THAT(loading(file("b.conf", with(kZed, "fx=700", "fx=seven")), {1280, 720}),
              ThrowsMessage<DataError>(HasSubstr("b.conf:2")));
}

TEST_F(CalibrationFormats, TablesOfCamerasAreChosenByName) {
  CalibrationSettings settings = file("camera_array.toml", kTables);
  std::vector<Camera> cameras = load_calibration(settings);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_NEAR(Eigen::AngleAxisd(cameras[0].camera_from_world.linear()).angle(), 0.5, 1e-12);
  EXPECT_EQ(cameras[1].distortion_model, DistortionModel::fisheye);
  settings.cameras = {"3", "0"};
  cameras = load_calibration(settings);
  EXPECT_EQ(cameras[0].width, 640);
  EXPECT_EQ(cameras[1].width, 1280);
  settings.cameras = {"1"};
  EXPECT_THAT(loading(settings),
              ThrowsMessage<DataError>(HasSubstr("no camera '1'; expected 0, 3")));
  EXPECT_THAT(
      loading(file("c.toml", with(kTables, "matrix = [[900.0, 0.0", "matrix = [[900.0, 0."))),
      ThrowsMessage<DataError>(HasSubstr("c.toml:5")));
  EXPECT_THAT(loading(file("c.toml", with(kTables, "translation", "place"))),
              ThrowsMessage<DataError>(HasSubstr("has no translation")));
}

TEST_F(CalibrationFormats, KeysOfVeryManyPartsAreRefused) {
  std::string key;
  for (int i = 0; i < 50'000; ++i) key += "x.";
  for (const std::string& text : {key + "y = 1\n", "[" + key + "y]\n", "a = {" + key + "y = 1}\n"})
    EXPECT_THAT(
        loading(file("deep.toml", "[cameras]\n" + text)),
        ThrowsMessage<DataError>(HasSubstr("deep.toml:2:1: has a key of more than 64 parts")));
  const std::string dots(100, '.');
  EXPECT_EQ(
      load_calibration(file("c.toml", kTables + ("# " + dots + "\ntitle = \"" + dots + "\"\n")))
          .size(),
      2u);
}

TEST_F(CalibrationFormats, RosPairsHaveTheirBaselineInTheProjectionMatrix) {
  CalibrationSettings settings = file("left.yaml", ros(0.1, 0));
  settings.second = write("right.yaml", ros(0.02, -48));
  const std::vector<Camera> cameras = load_calibration(settings);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].distortion.size(), 5u);
  // In the rectified frame the right camera is 0.1 m along x.
  const Eigen::Isometry3d& right = cameras[1].camera_from_world;
  EXPECT_NEAR(right.inverse().translation().norm(), 0.1, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(right.linear()).angle(), 0.08, 1e-12);
  const Eigen::Matrix3d rectified_from_left =
      Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_TRUE((rectified_from_left * right.inverse().translation())
                  .isApprox(Eigen::Vector3d(0.1, 0, 0), 1e-9));
  settings.second = write("right.yaml", ros(0, 0));
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("at one place")));
}

TEST_F(CalibrationFormats, OpenCvJsonIsReadAsItsYaml) {
  const std::vector<Camera> cameras = load_calibration(file("calibration.json", R"({
	"M1": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
	       "data": [530.0, 0.0, 342.5, 0.0, 531.0, 234.75, 0.0, 0.0, 1.0]},
	"D1": {"type_id": "opencv-matrix", "rows": 1, "cols": 4, "dt": "d", "data": [0.1, 0, 0, 0]},
	"M2": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
	       "data": [530.0, 0.0, 342.5, 0.0, 531.0, 234.75, 0.0, 0.0, 1.0]},
	"D2": {"type_id": "opencv-matrix", "rows": 1, "cols": 4, "dt": "d", "data": [0.1, 0, 0, 0]},
	"R": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
	      "data": [1, 0, 0, 0, 1, 0, 0, 0, 1]},
	"T": {"type_id": "opencv-matrix", "rows": 3, "cols": 1, "dt": "d", "data": [-0.1, 0, 0]}
})"));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1].camera_from_world.translation(), Eigen::Vector3d(-0.1, 0, 0));
}

TEST_F(CalibrationFormats, DamagedFilesEndWithAnErrorOrValidCameras) {
  std::mt19937 random(5);
  const std::string texts[] = {kKalibr, kZed, kTables, ros(0.1, -48)};
  int refused = 0;
  for (int trial = 0; trial < 800; ++trial) {
    std::string text = texts[trial % 4];
    for (std::size_t i = 0; i < 1 + random() % 4; ++i) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text[at] = "[]{}=:,-.\"'&*!|>%@0 \n"[random() % 21];
          break;
      }
      if (text.empty()) text = " ";
    }
    CalibrationSettings settings = file("damaged", text);
    settings.any_baseline = true;
    try {
      for (const Camera& camera : load_calibration(settings, {1280, 720})) {
        if (camera.width == 0) continue;
        EXPECT_NO_THROW(validate(camera, "camera")) << text;
      }
    } catch (const DataError& e) {
      ++refused;
      EXPECT_THAT(e.what(), HasSubstr("damaged")) << text;
    }
  }
  EXPECT_GT(refused, 200);
}

/// Returns how far apart two real cameras are, in metres, and the angle between their axes.
std::pair<double, double> apart(const CalibrationSettings& settings, ImageSize pictures = {}) {
  const std::vector<Camera> cameras = load_calibration(settings, pictures);
  const Eigen::Isometry3d from =
      cameras.at(1).camera_from_world * cameras.at(0).camera_from_world.inverse();
  return {from.translation().norm(), std::acos(from.linear()(2, 2)) * 180 / std::numbers::pi};
}

TEST(RealCalibrations, OfEveryFormatAreRead) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const std::filesystem::path folder = test::shared_data();
  CalibrationSettings settings;
  settings.file = folder / "calib/kalibr/euroc_mav.kalibr_imucam_chain.yaml";
  EXPECT_NEAR(apart(settings).first, 0.1101, 1e-4);
  settings.file = folder / "calib/kalibr/rs_t265.kalibr_imucam_chain.yaml";
  EXPECT_NEAR(apart(settings).first, 0.0627, 1e-4);
  settings.file = folder / "calib/kalibr/kaist_vio.kalibr_imucam_chain.yaml";
  EXPECT_GT(apart(settings).first, 0.03);
  settings.file = folder / "calib/zed/zed-cam-sn-1010.conf";
  for (const ImageSize size : {ImageSize{2208, 1242}, {1920, 1080}, {1280, 720}, {672, 376}}) {
    EXPECT_NEAR(apart(settings, size).first, 0.12, 1e-9);
    EXPECT_LT(apart(settings, size).second, 1);
    EXPECT_EQ(load_calibration(settings, size)[1].distortion[1], 0.0267266);
  }
  settings.file = folder / "stereo/rig/camera_array.toml";
  settings.cameras = {"0", "3"};
  EXPECT_NEAR(apart(settings).first, 0.4263, 1e-4);
  EXPECT_NEAR(apart(settings).second, 10.9, 0.05);
}

}  // namespace
}  // namespace hypotrack
