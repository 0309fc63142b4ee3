// camera_info of ROS: files of camera_calibration, and messages as `topic echo` writes them.

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cctype>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr const char* kRosFile = R"(image_width: 1280
image_height: 720
camera_name: top
camera_matrix: {rows: 3, cols: 3, data: [700, 0, 639.5, 0, 700, 359.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0.2, 0.003, 0.004, 0]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [700, 0, 639.5, 0, 0, 700, 359.5, 0, 0, 0, 1, 0]}
)";
constexpr const char* kLens = "{rows: 1, cols: 5, data: [0.1, 0.2, 0.003, 0.004, 0]}";
constexpr const char* kRow1 = "[700, 0, 639.5, 0, 0, 700, 359.5, 0, 0";

/// As `ros2 topic echo` writes it.
constexpr const char* kMessage = R"(header:
  stamp:
    sec: 12
    nanosec: 500
  frame_id: left_optical
height: 480
width: 640
distortion_model: plumb_bob
d: []
k:
- 500.0
- 0.0
- 320.0
- 0.0
- 501.0
- 240.0
- 0.0
- 0.0
- 1.0
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [500.0, 0.0, 320.0, 0.0, 0.0, 501.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
binning_y: 0
roi:
  x_offset: 0
  y_offset: 0
  height: 0
  width: 0
  do_rectify: false
---
)";

class RosCalibration : public test::CalibrationFiles {
 protected:
  CalibrationSettings pair(const std::string& first, const std::string& second) {
    CalibrationSettings settings = file("first.yaml", first);
    settings.second = write("second.yaml", second);
    return settings;
  }
  Camera only(const std::string& text) { return load_calibration(file("one.yaml", text)).at(0); }
};

TEST_F(RosCalibration, CamerasMayBeAboveEachOther) {
  const std::string bottom = with(kRosFile, kRow1, "[700, 0, 639.5, 0, 0, 700, 359.5, -84, 0");
  const std::vector<Camera> cameras = load_calibration(pair(kRosFile, bottom));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_TRUE(cameras[1].camera_from_world.inverse().translation().isApprox(
      Eigen::Vector3d(0, 0.12, 0), 1e-12));
  Camera pinhole = cameras[1];
  pinhole.distortion_model = DistortionModel::none;
  pinhole.distortion.clear();
  // 0.12 m above the axis of the lower camera: 700 * 0.12 / 0.6 = 140 pixels.
  const Eigen::Vector2d seen = project(pinhole, {0, 0, 0.6});
  EXPECT_NEAR(seen.x(), 639.5, 1e-9);
  EXPECT_NEAR(seen.y(), 359.5 - 140, 1e-9);
}

TEST_F(RosCalibration, CamerasMayBeBesideAndAboveEachOther) {
  const std::string other = with(kRosFile, kRow1, "[700, 0, 639.5, -70, 0, 350, 359.5, -17.5, 0");
  EXPECT_TRUE(
      load_calibration(pair(kRosFile, other))[1].camera_from_world.inverse().translation().isApprox(
          Eigen::Vector3d(0.1, 0.05, 0), 1e-12));
  // The place is one in the rectified frame, which a quarter turn about z makes another.
  const std::string turn = "[0, -1, 0, 1, 0, 0, 0, 0, 1]}\nproj";
  const std::string straight = "[1, 0, 0, 0, 1, 0, 0, 0, 1]}\nproj";
  const std::vector<Camera> turned =
      load_calibration(pair(with(kRosFile, straight, turn), with(other, straight, turn)));
  EXPECT_TRUE(turned[1].camera_from_world.inverse().translation().isApprox(
      Eigen::Vector3d(0.05, -0.1, 0), 1e-12));
  EXPECT_THAT(loading(pair(kRosFile, kRosFile)),
              ThrowsMessage<DataError>(AllOf(HasSubstr("second.yaml"), HasSubstr("at one place"))));
}

TEST_F(RosCalibration, DamagedProjectionsAreRefused) {
  EXPECT_THAT(
      loading(file("a.yaml", with(kRosFile, kRow1, "[700, 0, 639.5, 0, 0, 0, 359.5, 0, 0"))),
      ThrowsMessage<DataError>(HasSubstr("has the focal length 0; expected a positive")));
  EXPECT_THAT(
      loading(file("a.yaml", with(kRosFile, "359.5, 0, 0, 0, 1, 0]", "359.5, 0, 0, 0, 1, 2]"))),
      ThrowsMessage<DataError>(
          AllOf(HasSubstr("a.yaml:8"), HasSubstr("the last row 0 0 1 2; expected 0 0 1 0"))));
}

TEST_F(RosCalibration, AnEmptyPlumbBobIsNoDistortion) {
  for (const char* empty : {"[]", "{rows: 1, cols: 0, data: []}", "{rows: 0, cols: 0, data: []}"}) {
    const Camera camera = only(with(kRosFile, kLens, empty));
    EXPECT_EQ(camera.distortion_model, DistortionModel::none) << empty;
    EXPECT_THAT(camera.distortion, IsEmpty()) << empty;
  }
  EXPECT_EQ(only(kRosFile).distortion.size(), 5u);
  EXPECT_THAT(loading(file("a.yaml", with(kRosFile, kLens, "{rows: 1, cols: 5, data: []}"))),
              ThrowsMessage<DataError>(HasSubstr("has 0 numbers; expected 1 x 5 = 5")));
}

TEST_F(RosCalibration, OtherModelsNeedCoefficients) {
  for (const char* model : {"rational_polynomial", "equidistant"}) {
    const std::string text = with(with(kRosFile, kLens, "[]"), "plumb_bob", model);
    EXPECT_THAT(loading(file("a.yaml", text)),
                ThrowsMessage<DataError>(
                    AllOf(HasSubstr("a.yaml:6"), HasSubstr("is empty"), HasSubstr(model))));
  }
  EXPECT_THAT(loading(file("a.yaml", with(kRosFile, "plumb_bob", "thin_prism"))),
              ThrowsMessage<DataError>(AllOf(
                  HasSubstr("distortion_model is 'thin_prism'; expected one of plumb_bob, "))));
  EXPECT_THAT(loading(file("a.yaml", with(kRosFile, "plumb_bob", "none"))),
              ThrowsMessage<DataError>(HasSubstr("coefficients for the lens model 'none'")));
}

TEST_F(RosCalibration, MessagesAreRead) {
  std::string right = with(kMessage, "p: [500.0, 0.0, 320.0, 0.0", "p: [500.0, 0.0, 320.0, -50.0");
  right = with(right, "d: []", "d: [-0.1, 0.02, 0.001, 0.002, 0.0]");
  const std::vector<Camera> cameras = load_calibration(pair(kMessage, right));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].width, 640);
  EXPECT_EQ(cameras[0].height, 480);
  EXPECT_EQ(cameras[0].fy, 501);
  EXPECT_EQ(cameras[0].distortion_model, DistortionModel::none);
  EXPECT_THAT(cameras[1].distortion, ElementsAre(-0.1, 0.02, 0.001, 0.002, 0));
  EXPECT_TRUE(cameras[1].camera_from_world.inverse().translation().isApprox(
      Eigen::Vector3d(0.1, 0, 0), 1e-12));
  std::string of_ros_1 = kMessage;
  for (const char* key : {"d", "k", "r", "p"}) {
    const std::string capital(1, static_cast<char>(std::toupper(*key)));
    of_ros_1 = with(of_ros_1, std::string("\n") + key + ":", "\n" + capital + ":");
  }
  EXPECT_EQ(only(of_ros_1).fy, 501);
  EXPECT_THAT(read_calibration(file("a.yaml", kMessage)).notes, IsEmpty());
}

TEST_F(RosCalibration, EqualMessagesAreOne) {
  const std::string message = kMessage;
  EXPECT_EQ(only(message + message).fy, 501);
  EXPECT_EQ(only("---\n" + message + "# the end\n").fy, 501);
  EXPECT_EQ(only(message + with(message, "sec: 12", "sec: 13")).fy, 501);
  EXPECT_THAT(loading(file("a.yaml", message + with(message, "501.0", "502.0"))),
              ThrowsMessage<DataError>(AllOf(HasSubstr("a.yaml:30: a YAML document begins that "),
                                             HasSubstr("expected one document, or equal ones"))));
  EXPECT_THAT(loading(file("a.yaml", message + "height: [\n")),
              ThrowsMessage<DataError>(HasSubstr("a.yaml: document from line 30")));
  // Positions are those in the file.
  EXPECT_THAT(loading(file("a.yaml", "# a camera\n---\n" + with(message, "501.0", "wide"))),
              ThrowsMessage<DataError>(HasSubstr("a.yaml:17:")));
}

TEST_F(RosCalibration, MessagesOfPartsOfPicturesAreRefused) {
  EXPECT_THAT(loading(file("a.yaml", with(kMessage, "binning_x: 0", "binning_x: 2"))),
              ThrowsMessage<DataError>(AllOf(HasSubstr("a.yaml:22"), HasSubstr("binning_x is 2"))));
  EXPECT_THAT(loading(file("a.yaml", with(kMessage, "  x_offset: 0", "  x_offset: 8"))),
              ThrowsMessage<DataError>(HasSubstr("roi is a part of the pictures")));
  EXPECT_EQ(only(with(with(kMessage, "  height: 0", "  height: 480"), "  width: 0", "  width: 640"))
                .height,
            480);
}

TEST_F(RosCalibration, WithoutACameraMatrixIsOfRectifiedPictures) {
  const std::string matrix =
      "camera_matrix: {rows: 3, cols: 3, data: [700, 0, 639.5, 0, 700, 359.5, 0, 0, 1]}\n";
  const std::string zeros =
      "camera_matrix: {rows: 3, cols: 3, data: [0, 0, 0, 0, 0, 0, 0, 0, 0]}\n";
  for (const std::string& instead : {std::string(), zeros}) {
    const std::string left = with(kRosFile, matrix, instead);
    CalibrationSettings settings = file("first.yaml", left);
    settings.second = write("second.yaml",
                            with(left, "[700, 0, 639.5, 0, 0, 700,", "[710, 0, 640, -71, 0, 710,"));
    std::vector<std::string> notes;
    const std::vector<Camera> cameras = load_calibration(settings, {}, &notes);
    ASSERT_EQ(cameras.size(), 2);
    EXPECT_EQ(cameras[0].fx, 700);
    EXPECT_EQ(cameras[1].fx, 710);
    EXPECT_EQ(cameras[1].cx, 640);
    EXPECT_EQ(cameras[1].cy, 359.5);
    EXPECT_THAT(cameras[1].distortion, IsEmpty());
    EXPECT_TRUE(cameras[1].camera_from_world.translation().isApprox(Eigen::Vector3d(-0.1, 0, 0)));
    EXPECT_THAT(notes, testing::Contains(HasSubstr("its projection matrix is read, which is of "
                                                   "rectified pictures")));
  }
}

TEST_F(RosCalibration, UnknownKeysAreNamedInANoteForEachFile) {
  const std::string bottom = with(kRosFile, kRow1, "[700, 0, 639.5, 0, 0, 700, 359.5, -84, 0");
  const CalibrationSettings settings =
      pair(kRosFile + std::string("shutter: rolling\nskew: 1\n"), bottom + "date: today\n");
  EXPECT_THAT(read_calibration(settings).notes,
              ElementsAre(HasSubstr("first.yaml: not used: shutter, skew (not understood)"),
                          HasSubstr("second.yaml: not used: date (not understood)")));
}

}  // namespace
}  // namespace hypotrack
