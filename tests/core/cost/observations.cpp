#include "observations.hpp"

#include <memory>
#include <opencv2/core.hpp>

#include "test_models.hpp"

namespace hypotrack::test {
namespace {

TileView view_of(const TileCamera& camera) {
  TileView view;
  view.camera = camera;
  view.color = cv::Mat::zeros(camera.height, camera.width, CV_8UC3);
  view.valid = cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(255));
  return view;
}

}  // namespace

Observation rectified_pair(const Scene& scene, int size) {
  Observation observation;
  observation.scene = &scene;
  observation.rectified = true;
  TileCamera left;
  left.width = left.height = size;
  left.fx = left.fy = 240.0 * size / 128;
  left.cx = (size - 1) / 2.0 + 1.25;
  left.cy = (size - 1) / 2.0 + 20.5;
  TileCamera right = left;
  right.camera_from_world.translation().x() = -0.12;
  right.cx += right.fx * 0.12 / 0.5 - 2.75;
  observation.views = {view_of(left), view_of(right)};
  return observation;
}

Observation general_pair(const Scene& scene, int size) {
  const double scale = size / 128.0;
  Observation observation;
  observation.scene = &scene;
  TileCamera left;
  left.width = left.height = size;
  left.fx = 240 * scale;
  left.fy = 236 * scale;
  left.cx = 63 * scale;
  left.cy = 80 * scale;
  left.camera_from_world.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  TileCamera right = left;
  right.width = static_cast<int>(141 * scale);  // no multiple of a vector
  right.height = static_cast<int>(117 * scale);
  right.fx = 251 * scale;
  const Eigen::AngleAxisd turn(25 * 3.14159 / 180, Eigen::Vector3d(0.1, 1, 0.05).normalized());
  right.camera_from_world.linear() = turn.toRotationMatrix();
  // Looks at the same point, (0, 0, 0.5), from as far.
  right.camera_from_world.translation() =
      Eigen::Vector3d(0, 0, 0.5) - right.camera_from_world.linear() * Eigen::Vector3d(0, 0, 0.5);
  observation.views = {view_of(left), view_of(right)};
  return observation;
}

Scene hand_scene() { return Scene({{"hand", std::make_shared<const Model>(make_test_hand())}}); }

Scene hand_and_box_scene() {
  return Scene({{"hand", std::make_shared<const Model>(make_test_hand())},
                {"box", std::make_shared<const Model>(make_test_box())}});
}

}  // namespace hypotrack::test
