// Factory calibrations of ZED cameras.

#include <gmock/gmock.h>

#include <cctype>
#include <opencv2/calib3d.hpp>

#include "calibration_files.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

constexpr const char* kZedX = R"([LEFT_CAM_FHD1200]
fx = 740
fy = 741
cx = 961.2
cy = 602.1

[RIGHT_CAM_FHD1200]
fx = 742
fy = 743
cx = 957.4
cy = 598.7

[LEFT_CAM_SVGA]
fx = 370
fy = 370.5
cx = 480.6
cy = 301.05

[RIGHT_CAM_SVGA]
fx = 371
fy = 371.5
cx = 478.7
cy = 299.35

[LEFT_DISTO]
k1 = 0.3
k2 = -0.05
k3 = -0.002
k4 = 0.6
k5 = -0.02
k6 = -0.01
p1 = 0.0004
p2 = -0.0003

[RIGHT_DISTO]
k1 = 0.31
k2 = -0.051
k3 = -0.003
k4 = 0.61
k5 = -0.021
k6 = -0.011
p1 = 0.0005
p2 = -0.0006

[STEREO]
Baseline = 119.8
TY = 0
TZ = 0
CV_FHD1200 = 0
CV_SVGA = 0
RX_SVGA = 0
RZ_SVGA = 0

[MISC]
Sensor_ID = 1
)";
constexpr ImageSize kSvga{960, 600};

class ZedCalibration : public test::CalibrationFiles {
 protected:
  /// Returns a file with other coefficients of the left lens.
  static std::string with_left_lens(const std::string& coefficients) {
    std::string text = kZedX;
    const std::size_t begin = text.find("[LEFT_DISTO]\n") + 13, end = text.find("\n[RIGHT_DISTO]");
    return text.replace(begin, end - begin, coefficients);
  }
  std::vector<std::string> notes_on(const std::string& text) {
    return read_calibration(file("SN1.conf", text), kSvga).notes;
  }
};

TEST_F(ZedCalibration, LensOfAllSizesHasTheOrderOfOpenCv) {
  const std::vector<Camera> cameras = load_calibration(file("SN1.conf", kZedX), kSvga);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_THAT(cameras[0].distortion,
              ElementsAre(0.3, -0.05, 0.0004, -0.0003, -0.002, 0.6, -0.02, -0.01));
  EXPECT_THAT(cameras[1].distortion,
              ElementsAre(0.31, -0.051, 0.0005, -0.0006, -0.003, 0.61, -0.021, -0.011));
  const std::vector<cv::Point3d> points{{0.1, -0.08, 0.45}, {-0.2, 0.15, 0.4}};
  const cv::Matx33d left(370, 0, 480.6, 0, 370.5, 301.05, 0, 0, 1);
  const std::vector<double> lens{0.3, -0.05, 0.0004, -0.0003, -0.002, 0.6, -0.02, -0.01};
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), left, lens, pixels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d seen = project(cameras[0], {points[i].x, points[i].y, points[i].z});
    EXPECT_NEAR(seen.x(), pixels[i].x, 1e-9);
    EXPECT_NEAR(seen.y(), pixels[i].y, 1e-9);
    const Eigen::Vector2d pinhole(370 * points[i].x / points[i].z + 480.6,
                                  370.5 * points[i].y / points[i].z + 301.05);
    EXPECT_GT((seen - pinhole).norm(), 1);
  }
}

TEST_F(ZedCalibration, LensOfAllSizesMayHaveFiveCoefficients) {
  const std::string text =
      with_left_lens("k1 = -0.17\nk2 = 0.02\nk3 = 0.001\np1 = 0.0004\np2 = -0.0003\n");
  EXPECT_THAT(load_calibration(file("SN1.conf", text), kSvga)[0].distortion,
              ElementsAre(-0.17, 0.02, 0.0004, -0.0003, 0.001));
}

TEST_F(ZedCalibration, LensOfAllSizesWinsOverTheOlderOneOfASize) {
  const std::string text =
      with(kZedX, "cy = 301.05\n", "cy = 301.05\nk1 = -0.17\nk2 = 0.02\np1 = 0\np2 = 0\nk3 = 0\n");
  const Calibration read = read_calibration(file("SN1.conf", text), kSvga);
  EXPECT_EQ(read.cameras[0].camera.distortion.front(), 0.3);
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("[LEFT_CAM_SVGA] (the coefficients there")));
}

TEST_F(ZedCalibration, ACameraWithoutALensIsAnError) {
  const auto expected = [](const std::string& side) {
    return ThrowsMessage<DataError>(
        AllOf(HasSubstr("SN1.conf:"), HasSubstr("no lens: [" + side + "_CAM_SVGA] has "),
              HasSubstr("there is no [" + side + "_DISTO]; expected k1, k2, p1, p2, k3")));
  };
  EXPECT_THAT(loading(file("SN1.conf", with(kZedX, "LEFT_DISTO", "LEFT_LENS")), kSvga),
              expected("LEFT"));
  EXPECT_THAT(loading(file("SN1.conf", with(kZedX, "RIGHT_DISTO", "RIGHT_LENS")), kSvga),
              expected("RIGHT"));
  EXPECT_THAT(loading(file("SN1.conf", with_left_lens("c1 = 0.3\n")), kSvga),
              ThrowsMessage<DataError>(HasSubstr("there is no coefficient in [LEFT_DISTO]")));
}

TEST_F(ZedCalibration, HalfALensIsAnError) {
  EXPECT_THAT(loading(file("SN1.conf", with(kZedX, "p2 = -0.0003\n", "")), kSvga),
              ThrowsMessage<DataError>(
                  HasSubstr("[LEFT_DISTO] has k1, k2, p1, k3, k4, k5, k6 and no p2; expected k1, "
                            "k2, p1, p2, k3, k4, k5, k6")));
  EXPECT_THAT(loading(file("SN1.conf", with(with(kZedX, "[LEFT_DISTO]", "[LEFT_LENS]"),
                                            "cy = 301.05\n", "cy = 301.05\nk1 = -0.17\n")),
                      kSvga),
              ThrowsMessage<DataError>(HasSubstr("[LEFT_CAM_SVGA] has k1 and no k2")));
  EXPECT_THAT(loading(file("SN1.conf", with(kZedX, "p2 = -0.0003\n", "p2 = wide\n")), kSvga),
              ThrowsMessage<DataError>(HasSubstr("SN1.conf:")));
}

TEST_F(ZedCalibration, ThinPrismsAreReadUnlessTheyAreZero) {
  const auto lens_with = [&](const std::string& prisms) {
    const std::string text = with(kZedX, "[LEFT_DISTO]\n", "[LEFT_DISTO]\n" + prisms);
    return load_calibration(file("SN1.conf", text), kSvga)[0].distortion;
  };
  EXPECT_THAT(
      lens_with("s1 = 0.1\ns2 = 0.2\ns3 = 0.3\ns4 = 0.4\n"),
      ElementsAre(0.3, -0.05, 0.0004, -0.0003, -0.002, 0.6, -0.02, -0.01, 0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(lens_with("s1 = 0\n").size(), 8u);
  EXPECT_THAT([&] { lens_with("s1 = 0.1\n"); }, ThrowsMessage<DataError>(HasSubstr("has no s2")));
}

TEST_F(ZedCalibration, TheTranslationIsThatOfTheMakersCalibrationTool) {
  // The tool writes Baseline = -T.x, TY = T.y and TZ = T.z of p_right = R p_left + T.
  const std::string text = with(with(kZedX, "TY = 0", "TY = 1.5"), "TZ = 0", "TZ = -2.5");
  const Camera right = load_calibration(file("SN1.conf", text), kSvga)[1];
  EXPECT_TRUE(right.camera_from_world.translation().isApprox(
      Eigen::Vector3d(-0.1198, 0.0015, -0.0025), 1e-12));
}

TEST_F(ZedCalibration, AnglesOfOtherSizesCountWhereThoseOfThePicturesAreMissing) {
  const std::string text = with(kZedX, "CV_FHD1200 = 0\nCV_SVGA = 0", "CV_FHD1200 = 0.01");
  const Eigen::AngleAxisd turn(
      load_calibration(file("SN1.conf", text), kSvga)[1].camera_from_world.linear());
  EXPECT_NEAR(turn.angle(), 0.01, 1e-12);
  EXPECT_THAT(notes_on(with(kZedX, "RX_SVGA = 0\n", "")),
              testing::Contains(HasSubstr("has no RX_SVGA; 0 is taken for it")));
}

TEST_F(ZedCalibration, FourCoefficientsAreOfAFisheyeLens) {
  const std::string four = "k1 = 0.02\nk2 = -0.01\nk3 = 0.003\nk4 = -0.0005\n";
  std::string text = with_left_lens(four);
  const std::size_t begin = text.find("[RIGHT_DISTO]\n") + 14, end = text.find("\n[STEREO]");
  text.replace(begin, end - begin, four);
  CalibrationSettings settings = file("SN1.conf", text);
  // As the maker's calibration tool writes them.
  EXPECT_EQ(load_calibration(settings, kSvga)[1].distortion_model, DistortionModel::fisheye);
  settings.model = DistortionModel::brown;
  EXPECT_THAT(loading(settings, kSvga),
              ThrowsMessage<DataError>(HasSubstr("k1, k2, k3, k4 with `model: fisheye`")));
  settings.model = DistortionModel::fisheye;
  const Camera left = load_calibration(settings, kSvga)[0];
  EXPECT_EQ(left.distortion_model, DistortionModel::fisheye);
  EXPECT_THAT(left.distortion, ElementsAre(0.02, -0.01, 0.003, -0.0005));
  settings = file("SN2.conf", kZedX);
  settings.model = DistortionModel::fisheye;
  EXPECT_THAT(loading(settings, kSvga),
              ThrowsMessage<DataError>(HasSubstr("leave `model: fisheye` out")));
  const std::string padded = with_left_lens(four + "k5 = 0\nk6 = 0\np1 = 0\np2 = 0\n");
  EXPECT_THAT(notes_on(padded), testing::Contains(HasSubstr("write `model: fisheye`")));
}

TEST_F(ZedCalibration, IsTheSameInEveryFormOfAnIniFile) {
  const std::vector<Camera> expected = load_calibration(file("SN1.conf", kZedX), kSvga);
  const auto changed = [](std::string_view text, auto change) {
    std::string out;
    for (const char c : text) out += change(c);
    return out;
  };
  const auto lower = [](char c) { return std::string(1, static_cast<char>(std::tolower(c))); };
  const auto upper = [](char c) { return std::string(1, static_cast<char>(std::toupper(c))); };
  const auto breaks = [](char c) { return c == '\n' ? "\r\n" : std::string(1, c); };
  const auto comments = [](char c) { return c == '\n' ? " ; of the maker\n" : std::string(1, c); };
  const auto hashes = [](char c) { return c == '\n' ? "# 1 = [2]\n" : std::string(1, c); };
  const auto colons = [](char c) { return std::string(1, c == '=' ? ':' : c); };
  for (const std::string& text :
       {changed(kZedX, lower), changed(kZedX, upper), changed(kZedX, breaks),
        changed(kZedX, comments), changed(kZedX, hashes), changed(kZedX, colons),
        "\xEF\xBB\xBF; SN1\n\n" + std::string(kZedX),
        with(kZedX, "[LEFT_CAM_SVGA]", "[ Left_Cam_svga ]")}) {
    const auto settings = file("SN2.conf", text);
    const std::vector<Camera> cameras = load_calibration(settings, kSvga);
    ASSERT_EQ(cameras.size(), 2);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(cameras[i].fx, expected[i].fx) << text;
      EXPECT_EQ(cameras[i].distortion, expected[i].distortion);
      EXPECT_TRUE(cameras[i].camera_from_world.isApprox(expected[i].camera_from_world, 1e-12));
    }
  }
}

TEST_F(ZedCalibration, NamesThePlaceOfWhatIsNoNumber) {
  EXPECT_THAT(loading(file("SN1.conf", with(kZedX, "fx = 370\n", "fx = 370 px\n")), kSvga),
              ThrowsMessage<DataError>(AllOf(HasSubstr("SN1.conf:14:"), HasSubstr("'370 px'"))));
  EXPECT_THAT(loading(file("SN1.conf", std::string(kZedX) + "[STEREO]\nTY = 0\n"), kSvga),
              ThrowsMessage<DataError>(HasSubstr("cannot redefine existing table 'STEREO'")));
}

TEST_F(ZedCalibration, WhatIsNotUsedIsListedInOneNote) {
  EXPECT_THAT(notes_on(kZedX),
              ElementsAre(AllOf(HasSubstr("SN1.conf: not used: "),
                                HasSubstr("[LEFT_CAM_FHD1200], [RIGHT_CAM_FHD1200] (for pictures "
                                          "of other sizes)"),
                                Not(HasSubstr("SVGA")), Not(HasSubstr("not understood")))));
  std::string text = with(kZedX, "[LEFT_DISTO]\n", "[NEWS]\na = 1\n\n[LEFT_DISTO]\nk7 = 0.1\n");
  text = with(text, "[STEREO]\n", "[STEREO]\nCV_HUGE = 0\n");
  EXPECT_THAT(notes_on(text),
              ElementsAre(AllOf(HasSubstr("[NEWS]"), HasSubstr("[LEFT_DISTO] k7"),
                                HasSubstr("[STEREO] CV_HUGE"), HasSubstr("(not understood); "))));
  std::vector<std::string> notes;
  load_calibration(file("SN1.conf", text), kSvga, &notes);
  EXPECT_EQ(notes, notes_on(text));
}

TEST_F(ZedCalibration, AFileThatIsUsedAsAWholeHasNoNote) {
  const std::string text = kZedX;
  const std::string one_size = text.substr(text.find("[LEFT_CAM_SVGA]"));
  EXPECT_THAT(notes_on(one_size), IsEmpty());
}

}  // namespace
}  // namespace hypotrack
