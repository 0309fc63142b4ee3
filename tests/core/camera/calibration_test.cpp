#include "hypotrack/api/calibration.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <random>
#include <sstream>

#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kIntrinsics = R"(%YAML:1.0
---
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3e+02, 0., 342.5, 0., 531., 234.75, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -2.8e-01, 3.8e-02, 1.2e-03, -1.2e-04, 1.19e-01 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 537., 0., 327., 0., 536., 249., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.29, 0.13, -5.0e-04, 9.9e-05, -4.9e-02 ]
)";
constexpr const char* kExtrinsics = R"(%YAML:1.0
---
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 0.8, -0.6, 0., 0.6, 0.8 ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -8.3e+01, 1., -0.5 ]
)";
constexpr const char* kRig = R"(%YAML:1.0
---
units: cm
cameras:
  - name: left
    image_width: 1280
    image_height: 720
    model: none
    K: [700, 0, 640, 0, 701, 360, 0, 0, 1]
  - image_width: 640
    image_height: 480
    model: fisheye
    K: [[300, 0, 320], [0, 301, 240], [0, 0, 1]]
    D: [0.01, 0.02, 0.03, 0.04]
    R: [1, 0, 0, 0, 1, 0, 0, 0, 1]
    T: [-12, 0, 0]
  - image_width: 640
    image_height: 480
    K: [300, 0, 320, 0, 301, 240, 0, 0, 1]
    D: [0.01, 0.02, 0, 0, 0, 0.1, 0.2, 0.3]
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("the text does not hold " + what);
  return text.replace(at, what.size(), by);
}

class Calibration : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  CalibrationSettings stereo(const std::string& intrinsics = kIntrinsics,
                             const std::string& extrinsics = kExtrinsics) {
    CalibrationSettings settings;
    settings.file = write("intrinsics.yml", intrinsics);
    settings.extrinsics = write("extrinsics.yml", extrinsics);
    settings.units = LengthUnit::mm;
    return settings;
  }
  CalibrationSettings rig(const std::string& text = kRig) {
    CalibrationSettings settings;
    settings.file = write("rig.yml", text);
    settings.any_baseline = true;
    return settings;
  }
  auto loading(CalibrationSettings settings) {
    return [settings] { load_calibration(settings); };
  }
  test::TemporaryDirectory folder_;
};

TEST_F(Calibration, ReadsWhatStereoCalibWrites) {
  const std::vector<Camera> cameras = load_calibration(stereo());
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].fx, 530);
  EXPECT_EQ(cameras[0].fy, 531);
  EXPECT_EQ(cameras[0].cx, 342.5);
  EXPECT_EQ(cameras[0].cy, 234.75);
  EXPECT_EQ(cameras[0].distortion_model, DistortionModel::brown);
  EXPECT_EQ(cameras[0].distortion, (std::vector<double>{-0.28, 0.038, 1.2e-3, -1.2e-4, 0.119}));
  EXPECT_EQ(cameras[1].distortion.size(), 5u);
  EXPECT_TRUE(cameras[0].camera_from_world.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(cameras[1].camera_from_world.translation().isApprox(
      Eigen::Vector3d(-0.083, 0.001, -0.0005), 1e-12));
  EXPECT_NEAR(cameras[1].camera_from_world.linear()(2, 1), 0.6, 1e-12);
  EXPECT_EQ(cameras[0].width, 0) << "the files do not say";
}

TEST_F(Calibration, ReadsOneFileWithEverything) {
  std::string both = std::string(kIntrinsics) + std::string(kExtrinsics).substr(14);
  CalibrationSettings settings = stereo("units: mm\nimageSize: [640, 480]\n" + both.substr(14));
  settings.extrinsics.clear();
  settings.units.reset();
  const std::vector<Camera> cameras = load_calibration(settings);
  EXPECT_EQ(cameras[1].width, 640);
  EXPECT_EQ(cameras[1].height, 480);
  EXPECT_NEAR(cameras[1].camera_from_world.translation().x(), -0.083, 1e-12);
}

TEST_F(Calibration, ReadsTheListOfCameras) {
  const std::vector<Camera> cameras = load_calibration(rig());
  ASSERT_EQ(cameras.size(), 3u);
  EXPECT_EQ(cameras[0].width, 1280);
  EXPECT_EQ(cameras[0].distortion_model, DistortionModel::none);
  EXPECT_EQ(cameras[1].distortion_model, DistortionModel::fisheye);
  EXPECT_EQ(cameras[1].cy, 240);
  EXPECT_NEAR(cameras[1].camera_from_world.translation().x(), -0.12, 1e-12);
  EXPECT_EQ(cameras[2].distortion_model, DistortionModel::brown);
  EXPECT_EQ(cameras[2].distortion.size(), 8u);
}

TEST_F(Calibration, ReadsOneCameraOfTheCalibrationProgram) {
  CalibrationSettings settings;
  settings.file = write("camera.yaml", R"(%YAML:1.0
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 500., 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ 0.1, 0.2, 0.3, 0.4 ]
)");
  EXPECT_EQ(load_calibration(settings).at(0).distortion_model, DistortionModel::brown);
  settings.model = DistortionModel::fisheye;
  EXPECT_EQ(load_calibration(settings).at(0).distortion_model, DistortionModel::fisheye);
  EXPECT_EQ(load_calibration(settings).at(0).width, 640);
}

TEST_F(Calibration, TakesTwelveCoefficientsWhoseLastAreZero) {
  const std::string d = "[0.1, 0.2, 0, 0, 0.3, 0, 0, 0.1, 0, 0, 0, 0]";
  const std::string twelve = replaced(kRig, "[0.01, 0.02, 0, 0, 0, 0.1, 0.2, 0.3]", d);
  EXPECT_EQ(load_calibration(rig(twelve)).at(2).distortion.size(), 8u);
}

TEST_F(Calibration, TakesThinPrismsAndTiltedSensors) {
  const auto lens_of = [&](const std::string& more) {
    return load_calibration(
               rig(replaced(kRig, "0, 0, 0, 0.1, 0.2, 0.3]", "0, 0, 0, 0.1, 0.2, 0.3, " + more)))
        .at(2)
        .distortion;
  };
  EXPECT_THAT(lens_of("0.001]"), ElementsAre(0.01, 0.02, 0, 0, 0, 0.1, 0.2, 0.3, 0.001, 0, 0, 0));
  EXPECT_THAT(lens_of("0, 0, 0, 0, 0.02, 0]"),
              ElementsAre(0.01, 0.02, 0, 0, 0, 0.1, 0.2, 0.3, 0, 0, 0, 0, 0.02, 0));
}

TEST_F(Calibration, SaysThatMillimetresWereReadAsMetres) {
  CalibrationSettings settings = stereo();
  settings.units.reset();
  EXPECT_THAT(loading(settings),
              ThrowsMessage<DataError>(AllOf(
                  HasSubstr("extrinsics.yml: the baseline between cameras 0 and 1 is 83.0075 m"),
                  HasSubstr("write `units: mm`"), HasSubstr("`any_baseline: true`"))));
  settings.any_baseline = true;
  EXPECT_NO_THROW(load_calibration(settings));
  settings.any_baseline = false;
  settings.scale = 1e-3;
  EXPECT_NO_THROW(load_calibration(settings));
  settings.scale = 1;
  settings.units = LengthUnit::mm;
  settings.extrinsics = write("m.yml", replaced(kExtrinsics, "-8.3e+01, 1., -0.5", "0.12, 0, 0"));
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("is 0.00012 m")));
}

TEST_F(Calibration, SaysThatUnitsContradict) {
  CalibrationSettings settings = rig();
  settings.units = LengthUnit::mm;
  EXPECT_THAT(loading(settings),
              ThrowsMessage<DataError>(HasSubstr("the file is in cm, the scene says `units: mm`")));
}

TEST_F(Calibration, SaysWhichMatrixIsBadAndWhere) {
  const auto extrinsics = [&](const char* what, const char* by) {
    return loading(stereo(kIntrinsics, replaced(kExtrinsics, what, by)));
  };
  const auto intrinsics = [&](const char* what, const char* by) {
    return loading(stereo(replaced(kIntrinsics, what, by)));
  };
  EXPECT_THAT(
      extrinsics("0.8, -0.6", "0.9, -0.6"),
      ThrowsMessage<DataError>(AllOf(HasSubstr("extrinsics.yml:"), HasSubstr("R is no rotation"))));
  EXPECT_THAT(extrinsics("[ 1., 0.", "[ -1., 0."),
              ThrowsMessage<DataError>(HasSubstr("mirrored rotation")));
  EXPECT_THAT(extrinsics("[ 1., 0.", "[ .Nan, 0."),
              ThrowsMessage<DataError>(HasSubstr("R holds '.Nan'; expected finite numbers")));
  EXPECT_THAT(extrinsics("-8.3e+01", ".Inf"),
              ThrowsMessage<DataError>(HasSubstr("T holds '.Inf'")));
  EXPECT_THAT(extrinsics("-8.3e+01, ", ""),
              ThrowsMessage<DataError>(HasSubstr("T has 2 numbers; expected 3 x 1 = 3")));
  EXPECT_THAT(extrinsics("R: !!", "Q: !!"), ThrowsMessage<DataError>(HasSubstr("has no R; ")));
  EXPECT_THAT(extrinsics("dt: d", "dt: \"2d\""),
              ThrowsMessage<DataError>(HasSubstr("elements of type '2d'")));
  EXPECT_THAT(extrinsics("   rows: 3", "   rows: -3"),
              ThrowsMessage<DataError>(HasSubstr("R is -3; expected a whole number")));
  EXPECT_THAT(intrinsics("5.3e+02, 0.", "5.3e+02, 3."),
              ThrowsMessage<DataError>(HasSubstr("has a skew of 3")));
  EXPECT_THAT(intrinsics("5.3e+02", "nan"), ThrowsMessage<DataError>(HasSubstr("holds 'nan'")));
  EXPECT_THAT(intrinsics("5.3e+02", "-5.3e+02"),
              ThrowsMessage<DataError>(HasSubstr("camera 0: the focal lengths are fx = -530")));
  EXPECT_THAT(intrinsics("234.75, 0., 0., 1.", "0., 342.5, 234.75, 1."),
              ThrowsMessage<DataError>(HasSubstr("is it transposed?")));
  EXPECT_THAT(intrinsics("1.2e-03, ", ""), ThrowsMessage<DataError>(HasSubstr("has 4 numbers")));
  EXPECT_THAT(intrinsics("M2:", "M3:"), ThrowsMessage<DataError>(HasSubstr("has no M2; ")));
  EXPECT_THAT(loading(rig(replaced(kRig, "D: [0.01, 0.02, 0.03, 0.04]", "D: [0.01, 0.02, 0.03]"))),
              ThrowsMessage<DataError>(
                  HasSubstr("3 distortion coefficients for the lens model 'fisheye'")));
  EXPECT_THAT(
      loading(rig(replaced(kRig, "0, 0, 0, 0.1, 0.2, 0.3]",
                           "0, 0, 0, 0.1, 0.2, 0.3, 0, 0, 0, 0, 0, 0, 0, 0.4]"))),
      ThrowsMessage<DataError>(HasSubstr("has 16 coefficients; expected 4, 5, 8, 12 or 14")));
  EXPECT_THAT(loading(rig(replaced(kRig, "model: fisheye", "model: fisheyes"))),
              ThrowsMessage<DataError>(HasSubstr("expected one of none, brown, fisheye")));
  EXPECT_THAT(loading(rig(replaced(kRig, "    T: [-12, 0, 0]\n", ""))),
              ThrowsMessage<DataError>(HasSubstr("only one of R and T")));
  EXPECT_THAT(loading(rig(replaced(kRig, "- name:", "- nmae:"))),
              ThrowsMessage<DataError>(HasSubstr("a camera has no 'nmae'; expected name, ")));
}

TEST_F(Calibration, RefusesNumbersThatSuitNoImage) {
  const auto with = [&](const std::string& old, const std::string& by) {
    return loading(rig(replaced(kRig, old, by)));
  };
  EXPECT_THAT(with("[700, 0, 640,", "[700, 0, 1e40,"),
              ThrowsMessage<DataError>(AllOf(
                  HasSubstr("rig.yml: camera 0: the principal point's cx is 1e+40 pixels for an "
                            "image of 1280x720; expected -6400 to 6400"))));
  EXPECT_THAT(with("[0, 301, 240]", "[0, 301, -1e9]"),
              ThrowsMessage<DataError>(HasSubstr("camera 1: the principal point's cy is -1e+09")));
  EXPECT_THAT(
      with("[700, 0, 640,", "[1e9, 0, 640,"),
      ThrowsMessage<DataError>(HasSubstr("camera 0: the focal length fx is 1e+09 pixels for "
                                         "an image of 1280x720; expected 128 to 128000")));
  EXPECT_THAT(with("[0, 301, 240]", "[0, 1, 240]"),
              ThrowsMessage<DataError>(HasSubstr("camera 1: the focal length fy is 1 pixels")));
  EXPECT_THAT(
      with("D: [0.01,", "D: [1e100,"),
      ThrowsMessage<DataError>(AllOf(HasSubstr("rig.yml: camera 1: the distortion (1e+100, "),
                                     HasSubstr("moves pixel (0, 0) by"))));
  CalibrationSettings far = rig(replaced(kRig, "T: [-12, 0, 0]", "T: [1e40, 0, 0]"));
  far.any_baseline = true;
  EXPECT_THAT(loading(far), ThrowsMessage<DataError>(HasSubstr(
                                "rig.yml: camera 1: T puts the camera 1e+38 m from the origin")));
}

TEST_F(Calibration, RefusesALensThatFoldsInsideThePicture) {
  const auto with = [&](const std::string& coefficients) {
    return loading(rig(replaced(kRig, "D: [0.01, 0.02, 0.03, 0.04]", "D: " + coefficients)));
  };
  EXPECT_THAT(with("[-3, 0, 0, 0]"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("camera 1: with the distortion (-3, 0, 0, "
                                                       "0), nothing is seen farther than "),
                                             HasSubstr("expected 120 at least"))));
  EXPECT_NO_THROW(with("[-0.1, 0, 0, 0]")());
}

TEST_F(Calibration, RefusesNumbersThatDoNotSuitTheFirstImage) {
  std::vector<Camera> cameras = load_calibration(stereo());
  EXPECT_THAT(
      [&] { fit_image_size(cameras[0], 6400, 4800, "left.png"); },
      ThrowsMessage<DataError>(HasSubstr("the calibration for left.png: the focal length fx "
                                         "is 530 pixels for an image of 6400x4800")));
}

TEST_F(Calibration, SaysWhatItDoesNotRead) {
  CalibrationSettings settings;
  settings.file = folder_.path() / "none.yml";
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("no such file")));
  settings.file = "/dev/zero";
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("/dev/zero: is a device; ")));
  settings.file = write("camera.xml", "<?xml version=\"1.0\"?><opencv_storage/>");
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("is XML or compressed")));
  settings.file = write("other.yml", "cam0: {a: 1}\n");
  EXPECT_THAT(loading(settings),
              ThrowsMessage<DataError>(AllOf(HasSubstr("is no calibration"), HasSubstr("cam0"))));
  settings.file = write("broken.yml", "M1: [1, 2\nM2: }");
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("broken.yml:")));
  settings.file = write("empty.yml", "");
  EXPECT_THROW(load_calibration(settings), DataError);
}

TEST_F(Calibration, ComparesImageSizes) {
  CalibrationSettings settings = stereo();
  settings.image_size = {640, 480};
  std::vector<Camera> cameras = load_calibration(settings);
  EXPECT_EQ(cameras[0].width, 640);
  EXPECT_NO_THROW(fit_image_size(cameras[0], 640, 480, "left.png"));
  EXPECT_THAT(
      [&] { fit_image_size(cameras[0], 1280, 720, "left.png"); },
      ThrowsMessage<DataError>(HasSubstr(
          "left.png: the image is 1280x720 pixels, but its camera is calibrated for 640x480")));
  settings.image_size = {640};
  EXPECT_THAT(loading(settings), ThrowsMessage<DataError>(HasSubstr("image_size is [640]")));
  Camera unknown;
  fit_image_size(unknown, 320, 240, "x");
  EXPECT_EQ(unknown.width, 320);
}

TEST_F(Calibration, EndsWithAnErrorOrValidCamerasWhateverBytesAreDamaged) {
  std::mt19937 random(11);
  const std::string texts[] = {std::string(kIntrinsics) + std::string(kExtrinsics).substr(14),
                               kRig};
  int refused = 0;
  for (int trial = 0; trial < 600; ++trial) {
    std::string text = texts[trial % 2];
    const int damages = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < damages; ++i) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 40));
          break;
        default:
          text[at] = "[]{}:,-.\"'&*!|>%@0 \n"[random() % 20];
          break;
      }
      if (text.empty()) text = " ";
    }
    CalibrationSettings settings = rig(text);
    try {
      for (const Camera& camera : load_calibration(settings)) {
        if (camera.width == 0) continue;
        EXPECT_NO_THROW(validate(camera, "camera")) << text;
      }
    } catch (const DataError& e) {
      ++refused;
      EXPECT_THAT(e.what(), HasSubstr("rig.yml")) << text;
    }
  }
  EXPECT_GT(refused, 150);
}

TEST_F(Calibration, IsWhatTheManualShows) {
  std::ifstream manual(test::source_dir() / "docs/reference/recordings.md");
  std::string text, line;
  while (std::getline(manual, line) && line.find("%YAML:1.0") == std::string::npos) {
  }
  const std::size_t indent = line.find('%');
  for (; manual && line.find("```") == std::string::npos; std::getline(manual, line))
    text += line.substr(indent) + '\n';
  const std::vector<Camera> cameras = load_calibration(rig(text));
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_TRUE(cameras[0].camera_from_world.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(cameras[1].camera_from_world.translation(), Eigen::Vector3d(-0.12, 0, 0));
}

TEST(CalibrationOfOpenCv, IsReadFromTheRealFiles) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  CalibrationSettings settings;
  settings.file = test::shared_data() / "calib/opencv/intrinsics.yml";
  settings.extrinsics = test::shared_data() / "calib/opencv/extrinsics.yml";
  settings.units = LengthUnit::mm;
  const std::vector<Camera> cameras = load_calibration(settings);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_NEAR(cameras[1].camera_from_world.translation().norm(), 0.0832, 1e-4);
  EXPECT_NEAR(cameras[0].fx, 533.4167, 1e-3);
}

}  // namespace
}  // namespace hypotrack
