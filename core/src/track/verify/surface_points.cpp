#include "track/verify/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hypotrack {
namespace {

double fraction(double x) { return x - std::floor(x); }

}  // namespace

SurfacePoints spread_points(const Mesh& mesh, Eigen::Index count) {
  std::vector<double> area_up_to;  // and with each triangle
  double area = 0;
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3f a = mesh.vertices.col(triangle[0]);
    const Eigen::Vector3f ab = mesh.vertices.col(triangle[1]) - a;
    const Eigen::Vector3f ac = mesh.vertices.col(triangle[2]) - a;
    area += double{ab.cross(ac).norm()};
    area_up_to.push_back(area);
  }
  SurfacePoints out;
  if (!(area > 0)) return out;
  out.corners.resize(3, count);
  out.weights.resize(3, count);
  // Steps of the generalised golden ratio fill a square evenly (Roberts, "The unreasonable
  // effectiveness of quasirandom sequences", 2018).
  constexpr double kStep1 = 0.7548776662466927, kStep2 = 0.5698402909980532;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double at = area * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const auto triangle = std::ranges::lower_bound(area_up_to, at) - area_up_to.begin();
    out.corners.col(i) = mesh.triangles.col(triangle).template cast<int>();
    double u = fraction(kStep1 * static_cast<double>(i)),
           v = fraction(kStep2 * static_cast<double>(i));
    if (u + v > 1) u = 1 - u, v = 1 - v;
    out.weights.col(i) = Eigen::Vector3d(1 - u - v, u, v).cast<float>();
  }
  return out;
}

Eigen::Matrix3Xf positions(const SurfacePoints& points, const Eigen::Matrix3Xf& vertices) {
  Eigen::Matrix3Xf out(3, points.count());
  for (Eigen::Index i = 0; i < points.count(); ++i)
    out.col(i) = vertices(Eigen::all, points.corners.col(i)) * points.weights.col(i);
  return out;
}

}  // namespace hypotrack
