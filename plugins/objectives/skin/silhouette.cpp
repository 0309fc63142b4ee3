#include "silhouette.hpp"

#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::skin {
namespace {

constexpr int kShift = 4;  // fractional bits of fillConvexPoly's coordinates
constexpr float kNearest = 0.01f;
constexpr float kFarthest = 1e5f;  // in pixels; larger coordinates would overflow

/// Projects a vertex into a tile, in fillConvexPoly's units. Returns false if that is impossible.
bool project(const TileCamera& camera, const Eigen::Vector3f& p, cv::Point& pixel) {
  if (!(p.z() > kNearest)) return false;
  const float x = static_cast<float>(camera.fx) * p.x() / p.z() + static_cast<float>(camera.cx);
  const float y = static_cast<float>(camera.fy) * p.y() / p.z() + static_cast<float>(camera.cy);
  if (!(std::abs(x) < kFarthest) || !(std::abs(y) < kFarthest)) return false;
  pixel = {cvRound(x * (1 << kShift)), cvRound(y * (1 << kShift))};
  return true;
}

}  // namespace

cv::Mat1b silhouette(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera) {
  cv::Mat1b out(camera.height, camera.width, uchar{0});
  const Eigen::Isometry3f view = camera.camera_from_world.cast<float>();
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    const auto& triangles = item.model->data().mesh.triangles;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      cv::Point corners[3];
      bool drawn = true;
      for (int i = 0; i < 3; ++i) {
        drawn = drawn && project(camera, view * vertices.col(triangles(i, t)), corners[i]);
      }
      if (drawn) cv::fillConvexPoly(out, corners, 3, 255, cv::LINE_8, kShift);
    }
  }
  return out;
}

}  // namespace hypotrack::skin
