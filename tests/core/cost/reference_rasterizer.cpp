#include "reference_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cost/draw/raster_kernels.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::test {
namespace {

struct Corner {
  Eigen::Vector2d pixel;
  double inverse_depth = 0;
  bool drawable = false;
};

Corner project(const TileCamera& camera, const Eigen::Vector3d& world) {
  const Eigen::Vector3d p = camera.camera_from_world * world;
  Corner corner;
  corner.inverse_depth = 1 / p.z();
  corner.pixel << camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy;
  corner.drawable = p.z() >= kNear && p.z() <= kFar && corner.pixel.cwiseAbs().maxCoeff() <= kGuard;
  return corner;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

void draw(const std::array<Corner, 3>& t, Eigen::MatrixXd& tile) {
  const double area = cross(t[1].pixel - t[0].pixel, t[2].pixel - t[0].pixel);
  if (area == 0) return;
  const auto [x_low, x_high] = std::minmax({t[0].pixel.x(), t[1].pixel.x(), t[2].pixel.x()});
  const auto [y_low, y_high] = std::minmax({t[0].pixel.y(), t[1].pixel.y(), t[2].pixel.y()});
  const double last_x = std::min(x_high, static_cast<double>(tile.cols() - 1));
  const double last_y = std::min(y_high, static_cast<double>(tile.rows() - 1));
  for (double y = std::max(std::ceil(y_low), 0.0); y <= last_y; ++y) {
    for (double x = std::max(std::ceil(x_low), 0.0); x <= last_x; ++x) {
      const Eigen::Vector2d p(x, y);
      const double a = cross(t[1].pixel - p, t[2].pixel - p) / area;
      const double b = cross(t[2].pixel - p, t[0].pixel - p) / area;
      const double c = cross(t[0].pixel - p, t[1].pixel - p) / area;
      if (std::min({a, b, c}) < 0) continue;
      double& nearest = tile(static_cast<Eigen::Index>(y), static_cast<Eigen::Index>(x));
      nearest = std::max(nearest,
                         a * t[0].inverse_depth + b * t[1].inverse_depth + c * t[2].inverse_depth);
    }
  }
}

}  // namespace

Eigen::MatrixXd reference_inverse_depth(const Scene& scene, const Eigen::VectorXd& state,
                                        const TileCamera& camera) {
  Eigen::MatrixXd tile = Eigen::MatrixXd::Zero(camera.height, camera.width);
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    for (const auto& t : item.model->data().mesh.triangles.colwise()) {
      std::array<Corner, 3> corners;
      for (int k = 0; k < 3; ++k) {
        corners[static_cast<std::size_t>(k)] = project(camera, vertices.col(t[k]).cast<double>());
      }
      if (std::ranges::all_of(corners, &Corner::drawable)) draw(corners, tile);
    }
  }
  return tile;
}

}  // namespace hypotrack::test
