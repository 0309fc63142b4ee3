#include "patch_pair.hpp"

#include <cmath>
#include <memory>

#include "test_models.hpp"

namespace hypotrack::stereo_patch {
namespace {

const Scene& box_scene() {
  static const Scene scene(
      {{"box", std::make_shared<const Model>(test::make_test_box({0.06, 0.04, 0.02}))}});
  return scene;
}

// A texture fixed to a plane at 0.5 m, seen by a camera.
void paint(TileView& view) {
  const Eigen::Isometry3d world_from_camera = view.camera.camera_from_world.inverse();
  const TileCamera& c = view.camera;
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      const Eigen::Vector3d ray =
          world_from_camera.linear() * Eigen::Vector3d((x - c.cx) / c.fx, (y - c.cy) / c.fy, 1);
      const Eigen::Vector3d from = world_from_camera.translation();
      const Eigen::Vector3d p = from + ray * (0.5 - from.z()) / ray.z();
      const double value = 110 + 40 * std::sin(900 * p.x()) * std::cos(700 * p.y()) +
                           30 * std::sin(1300 * p.x() + 500 * p.y());
      view.color.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(value));
    }
  }
}

}  // namespace

PatchPair::PatchPair(const PairOptions& options, bool smooth) : RandomPair(options) {
  observation.scene = &box_scene();
  observation.start = box_scene().rest_state();
  observation.start[2] = 0.5;
  if (!smooth) return;
  for (TileView& view : observation.views) paint(view);
}

void change_brightness(TileView& view, double gain, double offset) {
  cv::Mat changed;
  view.color.convertTo(changed, CV_8U, gain, offset);
  view.color = changed;
}

}  // namespace hypotrack::stereo_patch
