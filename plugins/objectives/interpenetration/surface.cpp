#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hypotrack::interpenetration {
namespace {

double distance_from_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - a - t * along).norm();
}

/// Returns the distance to the plane if the foot lies in the triangle, otherwise to the nearest
/// edge.
double distance_from_triangle(const Eigen::Vector3d& point, const Eigen::Matrix3d& corners) {
  const Eigen::Vector3d a = corners.col(0), b = corners.col(1), c = corners.col(2);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > 0) {
    const double u = normal.dot((c - b).cross(point - b)) / area;
    const double v = normal.dot((a - c).cross(point - c)) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) return std::abs(normal.dot(point - a)) / std::sqrt(area);
  }
  return std::min({distance_from_segment(point, a, b), distance_from_segment(point, b, c),
                   distance_from_segment(point, c, a)});
}

}  // namespace

Surface::Surface(const Mesh& mesh) {
  for (const auto& t : mesh.triangles.colwise()) {
    Triangle triangle;
    triangle.corners = mesh.vertices(Eigen::all, t).cast<double>();
    triangle.center = triangle.corners.rowwise().mean();
    triangle.radius = (triangle.corners.colwise() - triangle.center).colwise().norm().maxCoeff();
    triangles_.push_back(triangle);
  }
}

double Surface::distance(const Eigen::Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles_) {
    const double bound = nearest + triangle.radius;
    if ((point - triangle.center).squaredNorm() > bound * bound) continue;
    nearest = std::min(nearest, distance_from_triangle(point, triangle.corners));
  }
  return nearest;
}

double Surface::volume() const {
  double sum = 0;  // six times the volumes of tetrahedra from the origin
  for (const Triangle& triangle : triangles_) sum += triangle.corners.determinant();
  return std::abs(sum) / 6;
}

}  // namespace hypotrack::interpenetration
