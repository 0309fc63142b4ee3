#include "track/recover/silhouette.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "model/posing.hpp"
#include "scene/mesh_topology.hpp"

namespace hypotrack::internal {
namespace {

/// Returns twice the area of a triangle, negative if it turns the other way.
int twice_area(const cv::Point& a, const cv::Point& b, const cv::Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Fills a triangle: of a small one the pixels whose centres are inside. Most are small, for which
/// cv::fillConvexPoly(), which draws the edges as well, takes ten times as long.
void fill(const std::array<cv::Point, 3>& corners, cv::Mat1b& out) {
  constexpr int kSmall = 8;  // pixels
  auto [a, b, c] = corners;
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
  if (right - left > kSmall || bottom - top > kSmall) {
    cv::fillConvexPoly(out, corners.data(), 3, 255);
    return;
  }
  if (twice_area(a, b, c) < 0) std::swap(b, c);
  for (int y = std::max(top, 0); y <= std::min(bottom, out.rows - 1); ++y)
    for (int x = std::max(left, 0); x <= std::min(right, out.cols - 1); ++x) {
      const cv::Point p(x, y);
      if (std::min({twice_area(a, b, p), twice_area(b, c, p), twice_area(c, a, p)}) >= 0)
        out(p) = 255;
    }
}

}  // namespace

cv::Mat1b silhouettes(const Scene& scene, const std::vector<bool>& models,
                      const Eigen::VectorXd& state, const Camera& camera, int reduction) {
  cv::Mat1b out(std::max(1, camera.height / reduction), std::max(1, camera.width / reduction),
                uchar{0});
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!models[m]) continue;
    const Scene::Item& item = scene.items()[m];
    const Mesh& mesh = simplified_mesh(*item.model);
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, mesh, scene.part(item, state));
    std::vector<Eigen::Vector2d> pixels;
    pixels.reserve(static_cast<std::size_t>(vertices.cols()));
    for (const auto& vertex : vertices.colwise())
      pixels.push_back(project(camera, vertex.cast<double>()) / reduction);
    for (const auto& triangle : mesh.triangles.colwise()) {
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
