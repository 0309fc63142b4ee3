#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

Camera camera_at(double x) {
  Camera camera{320, 240, 250, 255, 161.5, 117.5, DistortionModel::none, {}, {}};
  camera.camera_from_world.setIdentity();
  camera.camera_from_world.rotate(Eigen::AngleAxisd(0.1 * x, Eigen::Vector3d::UnitY()));
  camera.camera_from_world.translate(Eigen::Vector3d(-x, 0, 0));
  return camera;
}

/// The scene's silhouette, drawn by OpenCV.
cv::Mat silhouette(const Scene& scene, const Camera& camera, const Eigen::VectorXd& state) {
  constexpr int kShift = 8;
  cv::Mat drawn(camera.height, camera.width, CV_8UC1, cv::Scalar(0));
  for (const auto& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    for (const auto& triangle : item.model->data().mesh.triangles.colwise()) {
      std::array<cv::Point, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d p = project(camera, vertices.col(triangle[k]).cast<double>());
        corners[static_cast<std::size_t>(k)] = {
            static_cast<int>(std::lround(p.x() * (1 << kShift))),
            static_cast<int>(std::lround(p.y() * (1 << kShift)))};
      }
      cv::fillConvexPoly(drawn, corners.data(), 3, cv::Scalar(255), cv::LINE_8, kShift);
    }
  }
  return drawn;
}

struct ForegroundOverlapTest : testing::Test {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())},
               {"hand", std::make_shared<Model>(test::make_test_hand())}}};
  std::vector<Camera> cameras{camera_at(0), camera_at(0.1)};
  TileMaker tiles{scene, cameras, {}};

  static Frame frame(const cv::Mat& first, const cv::Mat& second) {
    const cv::Mat grey(240, 320, CV_8UC3, cv::Scalar(90, 90, 90));
    Frame frame;
    frame.views = {{grey, first}, {grey, second}};
    return frame;
  }
};

TEST_F(ForegroundOverlapTest, IsWhereTheDrawnSilhouetteIs) {
  std::mt19937_64 random(6);
  int inside = 0, outside = 0;
  const cv::Mat nine(9, 9, CV_8UC1, cv::Scalar(1));
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd state = test::random_state(scene, random, {0.05, 0, 0.5}, 0.2);
    if (tiles.visible_share(state) == 0) continue;
    const cv::Mat drawn = silhouette(scene, cameras[0], state);
    cv::Mat inner, outer;
    cv::erode(drawn, inner, nine);
    cv::dilate(drawn, outer, nine);
    for (int k = 0; k < 50; ++k) {
      const cv::Point at(static_cast<int>(random() % 320), static_cast<int>(random() % 240));
      cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(0));
      mask.at<std::uint8_t>(at) = 255;
      const ForegroundOverlap found = tiles.foreground_overlap(frame(mask, {}), state);
      if (inner.at<std::uint8_t>(at)) {
        EXPECT_EQ(found, ForegroundOverlap::yes) << i << ", " << at;
        ++inside;
      } else if (!outer.at<std::uint8_t>(at)) {
        EXPECT_EQ(found, ForegroundOverlap::nowhere) << i << ", " << at;
        ++outside;
      }
    }
  }
  EXPECT_GT(inside, 20);
  EXPECT_GT(outside, 100);
}

TEST_F(ForegroundOverlapTest, IsOnAllMasksThatThereAreInPartsOrNowhere) {
  Eigen::VectorXd state = scene.rest_state();
  for (const auto& item : scene.items()) state[item.offset + 2] = 0.5;
  const cv::Mat all(240, 320, CV_8UC1, cv::Scalar(255)), nothing(240, 320, CV_8UC1, cv::Scalar(0));
  const auto found = [&](const cv::Mat& first, const cv::Mat& second) {
    return tiles.foreground_overlap(frame(first, second), state);
  };
  EXPECT_EQ(found(all, all), ForegroundOverlap::yes);
  EXPECT_EQ(found({}, all), ForegroundOverlap::yes);
  EXPECT_EQ(found(all, nothing), ForegroundOverlap::in_parts);
  EXPECT_EQ(found(nothing, all), ForegroundOverlap::in_parts);
  EXPECT_EQ(found(nothing, nothing), ForegroundOverlap::nowhere);
  EXPECT_EQ(found({}, nothing), ForegroundOverlap::nowhere);
  EXPECT_EQ(found({}, {}), ForegroundOverlap::unknown);
  for (const auto& item : scene.items()) state[item.offset + 2] = -0.5;
  EXPECT_EQ(found(all, all), ForegroundOverlap::nowhere);
}

TEST_F(ForegroundOverlapTest, MasksOfAnotherDistanceShareNoPointOfIt) {
  // Silhouettes of the scene at 0.5 m, seen 50 pixels apart; at 2 m a point's pixels are 13 apart.
  Eigen::VectorXd state = scene.rest_state();
  for (const auto& item : scene.items()) state[item.offset + 2] = 2;
  cv::Mat left(240, 320, CV_8UC1, cv::Scalar(0)), right = left.clone();
  const cv::Rect middle(155, 110, 14, 14);
  left(middle).setTo(255);
  right(middle - cv::Point(13, 0)).setTo(255);
  ASSERT_EQ(tiles.foreground_overlap(frame(left, right), state), ForegroundOverlap::yes);
  right.setTo(0);
  right(middle - cv::Point(50, 0)).setTo(255);
  EXPECT_EQ(tiles.foreground_overlap(frame(left, right), state), ForegroundOverlap::in_parts);
}

}  // namespace
}  // namespace hypotrack
