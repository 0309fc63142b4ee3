#include "track/recover/depth_weights.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace hypotrack {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kFocal = 150, kBaseline = 0.1;

std::vector<Camera> small_pair() {
  Camera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = kFocal;
  camera.cx = (kWidth - 1) / 2.0;
  camera.cy = (kHeight - 1) / 2.0;
  std::vector<Camera> cameras{camera, camera};
  cameras[1].camera_from_world.translation().x() = -kBaseline;
  return cameras;
}

/// A pair of pictures of a textured wall with a textured board in the middle before it.
std::array<cv::Mat3b, 2> pictures(double wall, double board) {
  cv::RNG random(5);
  cv::Mat3b wide(kHeight, 2 * kWidth);
  random.fill(wide, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(wide, wide, {}, 1);
  const auto shift = [](double depth) { return static_cast<int>(kFocal * kBaseline / depth); };
  const cv::Rect middle(60, 40, 40, 40);
  std::array<cv::Mat3b, 2> out;
  for (const int view : {0, 1}) {
    out[view] = wide(cv::Rect(view * shift(wall), 0, kWidth, kHeight)).clone();
    wide(cv::Rect(200, 10, 40, 40)).copyTo(out[view](middle - cv::Point(view * shift(board), 0)));
  }
  return out;
}

double mean(const cv::Mat1f& weights, const cv::Rect& part) { return cv::mean(weights(part))[0]; }

TEST(DepthWeights, AreHighOnSurfacesInTheRangeAndLowBehindIt) {
  DepthWeights depths(small_pair(), {1, 1}, 0.25, 1.2);
  const auto weights = depths.weights(pictures(3.0, 0.5));
  EXPECT_GT(mean(weights[0], {66, 46, 28, 28}), 0.9);
  EXPECT_GT(mean(weights[1], {36, 46, 28, 28}), 0.9);
  EXPECT_LT(mean(weights[0], {110, 10, 40, 20}), 0.2);
  EXPECT_LT(mean(weights[1], {110, 90, 40, 20}), 0.2);
}

TEST(DepthWeights, SayLittleOfUniformPictures) {
  DepthWeights depths(small_pair(), {1, 1}, 0.25, 1.2);
  const cv::Mat3b gray(kHeight, kWidth, cv::Vec3b(90, 90, 90));
  const auto weights = depths.weights({gray, gray});
  const double middle = mean(weights[0], {60, 40, 40, 40});
  EXPECT_GT(middle, 0.4);
  EXPECT_LT(middle, 0.9);
}

}  // namespace
}  // namespace hypotrack
