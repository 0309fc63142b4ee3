#include "track/recover/silhouette.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::internal {
namespace {

/// Fills a triangle. Those of fine meshes are mostly corners beside each other, for which
/// cv::fillConvexPoly() takes ten times as long.
void fill(const std::array<cv::Point, 3>& corners, cv::Mat1b& out) {
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  if (right - left > 1 || bottom - top > 1) {
    cv::fillConvexPoly(out, corners.data(), 3, 255);
    return;
  }
  const cv::Rect inside({}, out.size());
  for (const cv::Point& corner : corners)
    if (inside.contains(corner)) out(corner) = 255;
}

}  // namespace

cv::Mat1b silhouettes(const Scene& scene, const std::vector<bool>& models,
                      const Eigen::VectorXd& state, const Camera& camera, int reduction) {
  cv::Mat1b out(std::max(1, camera.height / reduction), std::max(1, camera.width / reduction),
                uchar{0});
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!models[m]) continue;
    const Scene::Item& item = scene.items()[m];
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    std::vector<Eigen::Vector2d> pixels;
    for (const auto& vertex : vertices.colwise())
      pixels.push_back(project(camera, vertex.cast<double>()) / reduction);
    for (const auto& triangle : item.model->data().mesh.triangles.colwise()) {
      std::array<cv::Point, 3> corners;
      bool drawn = true;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector2d& p = pixels[static_cast<std::size_t>(triangle[i])];
        drawn = drawn && p.cwiseAbs().maxCoeff() < 1e4;  // false for NaN
        if (drawn) corners[static_cast<std::size_t>(i)] = {cvRound(p.x()), cvRound(p.y())};
      }
      if (drawn) fill(corners, out);
    }
  }
  return out;
}

}  // namespace hypotrack::internal
