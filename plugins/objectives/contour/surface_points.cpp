#include "surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hypotrack::contour {
namespace {

/// Returns number i of a sequence that fills the unit interval evenly (Weyl, with a step that is
/// irrational).
double even(int i, double step) { return std::fmod(0.5 + i * step, 1.0); }

/// Returns six times the volume within a mesh; negative if its triangles face inwards. Openings are
/// closed from the middle.
double volume(const Mesh& mesh) {
  const Eigen::Vector3f middle = mesh.vertices.rowwise().mean();
  double sum = 0;
  for (const Eigen::Vector3i corner : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(corner[0]) - middle;
    const Eigen::Vector3f b = mesh.vertices.col(corner[1]) - middle;
    sum += double{a.dot(b.cross(mesh.vertices.col(corner[2]) - middle))};
  }
  return sum;
}

}  // namespace

std::vector<SurfacePoint> spread_points(const Mesh& mesh, int count) {
  std::vector<double> areas;  // up to each triangle's end
  double sum = 0;
  std::vector<Eigen::Vector3f> normals;
  for (const Eigen::Vector3i corner : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(corner[0]);
    const Eigen::Vector3f normal =
        (mesh.vertices.col(corner[1]) - a).cross(mesh.vertices.col(corner[2]) - a);
    sum += double{normal.norm()};
    areas.push_back(sum);
    normals.push_back(normal.normalized());
  }
  std::vector<SurfacePoint> out;
  if (!(sum > 0)) return out;
  if (volume(mesh) < 0)
    for (Eigen::Vector3f& normal : normals) normal = -normal;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count * sum;
    const auto t = static_cast<Eigen::Index>(std::ranges::lower_bound(areas, at) - areas.begin());
    const Eigen::Vector3i corner = mesh.triangles.col(std::min(t, mesh.triangles.cols() - 1));
    // Of the unit square, the half beyond the diagonal is folded back.
    auto u = static_cast<float>(even(i, 0.7548776662)),
         v = static_cast<float>(even(i, 0.5698402910));
    if (u + v > 1) u = 1 - u, v = 1 - v;
    out.push_back({(1 - u - v) * mesh.vertices.col(corner[0]) + u * mesh.vertices.col(corner[1]) +
                       v * mesh.vertices.col(corner[2]),
                   normals[static_cast<std::size_t>(std::min(t, mesh.triangles.cols() - 1))]});
  }
  return out;
}

}  // namespace hypotrack::contour
