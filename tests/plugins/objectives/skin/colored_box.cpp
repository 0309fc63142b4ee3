#include "colored_box.hpp"

#include <opencv2/imgproc.hpp>

#include "color_learner.hpp"
#include "depth_scene.hpp"

namespace hypotrack::skin {
namespace {

constexpr int kSize = 96;

cv::Mat3b noisy(const cv::Scalar& mean, cv::RNG& random) {
  cv::Mat3f noise(kSize, kSize);
  random.fill(noise, cv::RNG::NORMAL, 0, 12);
  cv::Mat3b out;
  cv::Mat(noise + mean).convertTo(out, CV_8U);
  return out;
}

TileView blank() {
  TileView view;
  view.camera = {kSize, kSize, 300, 300, kSize / 2.0, kSize / 2.0, Eigen::Isometry3d::Identity()};
  view.valid = cv::Mat1b(kSize, kSize, uchar{255});
  return view;
}

}  // namespace

Observation colored_box() {
  cv::RNG random(5);
  Observation out;
  out.scene = &rgbd_depth::box_scene();
  out.start = rgbd_depth::box_state();
  for (int i = 0; i < 2; ++i) {
    TileView view = blank();
    cv::Mat3b color = noisy({150, 90, 60}, random);
    noisy({80, 100, 170}, random).copyTo(color, silhouette(*out.scene, out.start, view.camera));
    view.color = color;
    out.views.push_back(view);
  }
  return out;
}

cv::Rect box_outline() {
  return cv::boundingRect(
      silhouette(rgbd_depth::box_scene(), rgbd_depth::box_state(), blank().camera));
}

Rectangle::Rectangle(const Observation& observation, const cv::Rect& covered) {
  for (const TileView& view : observation.views) {
    const int width = view.camera.width, height = view.camera.height;
    auto& memory = memory_.emplace_back(static_cast<std::size_t>(width) * height, 0.0f);
    cv::Mat1f(height, width, memory.data())(covered).setTo(2);
    tiles_.push_back({width, height, width, memory.data(), covered.x, covered.y,
                      covered.x + covered.width, covered.y + covered.height});
  }
}

}  // namespace hypotrack::skin
