// Real pictures, with hands and without.
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/image_file.hpp"
#include "pictures.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// The point nearest to the rays through two pixels of cameras without distortion.
Eigen::Vector3d triangulated(const std::vector<Camera>& cameras, const Eigen::Vector2d& left,
                             const Eigen::Vector2d& right) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < 2; ++v) {
    const Camera& c = cameras[v];
    const Eigen::Vector2d& p = v == 0 ? left : right;
    const Eigen::Isometry3d world_from_camera = c.camera_from_world.inverse();
    const Eigen::Vector3d ray =
        world_from_camera.linear() *
        Eigen::Vector3d((p.x() - c.cx) / c.fx, (p.y() - c.cy) / c.fy, 1).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    normal += across;
    side += across * world_from_camera.translation();
  }
  return normal.ldlt().solve(side);
}

TEST(RealHand, OfTheStbPairIsFoundWithinTwelveMillimetresOfItsLabels) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  HandDetector detector({});
  const auto pictures = test::stb_pair();
  const HandDetection left = test::only_hand(detector, pictures.picture(0));
  const HandDetection right = test::only_hand(detector, pictures.picture(1));
  EXPECT_LT(left.right, 0.5) << "it is a left hand";
  EXPECT_LT(right.right, 0.5);
  double sum = 0;
  for (Eigen::Index i = 1; i < 21; ++i) {  // the wrist has no label
    const Eigen::Vector3d point =
        triangulated(pictures.cameras, left.landmarks.col(i), right.landmarks.col(i));
    sum += 1e3 * (point - pictures.frame.truth->landmarks.col(i)).norm();
  }
  RecordProperty("mean_mm", std::to_string(sum / 20));
  EXPECT_LT(sum / 20, 12);
}

TEST(RealHand, InGreyIsFoundAtTheSamePlace) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  HandDetector detector({});
  const auto pictures = test::stb_pair();
  for (std::size_t view = 0; view < 2; ++view) {
    const cv::Mat& picture = pictures.picture(view);
    cv::Mat grey, three_channels;
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    cv::cvtColor(grey, three_channels, cv::COLOR_GRAY2BGR);
    const HandDetection hand = test::only_hand(detector, grey);
    EXPECT_GT(hand.palm_score, 0.5);
    EXPECT_LT(test::mean_distance(hand.landmarks, test::only_hand(detector, picture).landmarks), 6);
    EXPECT_EQ(test::only_hand(detector, three_channels).landmarks, hand.landmarks);
  }
}

TEST(RealHand, IsFoundInPicturesOfEverySize) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  HandDetector detector({});
  const cv::Mat picture = test::stb_pair().picture();
  const HandPoints points = test::only_hand(detector, picture).landmarks;
  for (const double scale : {0.25, 0.5, 2.0}) {
    cv::Mat resized;
    cv::resize(picture, resized, {}, scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
    const HandPoints expected = (scale * (points.array() + 0.5) - 0.5).matrix();
    EXPECT_LT(test::mean_distance(test::only_hand(detector, resized).landmarks, expected),
              4 * scale)
        << "scale " << scale;
  }
}

TEST(RealHand, IsFoundInBothViewsOfMostFramesOfAVideo) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  HandDetector detector({.smallest_hand = 0});
  const auto frames = test::webcam_frames(20);
  int in_both = 0;
  for (const auto& pictures : frames) {
    in_both += !detector.detect(pictures.picture(0)).empty() &&
               !detector.detect(pictures.picture(1)).empty();
  }
  RecordProperty("found", in_both);
  RecordProperty("frames", static_cast<int>(frames.size()));
  EXPECT_GT(in_both, 0.8 * static_cast<double>(frames.size()));
}

TEST(RealHand, IsNotFoundInPicturesWithoutHands) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HYPOTRACK_NEEDS_SHARED_DATA();
  HandDetector detector({});
  int pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::shared_data() / "images")) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".jpg") && !name.starts_with("graf")) continue;
    const ReadImage read = read_color(entry.path());
    ASSERT_EQ(read.problem, "");
    EXPECT_TRUE(detector.detect(read.image).empty()) << name;
    cv::Mat half;
    cv::resize(read.image, half, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::cvtColor(half, half, cv::COLOR_BGR2GRAY);
    EXPECT_TRUE(detector.detect(half).empty()) << name << " in grey";
    ++pictures;
  }
  EXPECT_GE(pictures, 8);
}

}  // namespace
}  // namespace hypotrack
