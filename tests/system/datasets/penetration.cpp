#include "penetration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hypotrack::test {
namespace {

using Eigen::Vector3f;

/// Solid angle of a triangle as seen from the origin (van Oosterom and Strackee, "The solid angle
/// of a plane triangle", 1983).
double solid_angle(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const float la = a.norm(), lb = b.norm(), lc = c.norm();
  const float volume = a.dot(b.cross(c));
  const float denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(volume, denominator);
}

double to_segment(const Vector3f& p, const Vector3f& a, const Vector3f& b) {
  const Vector3f ab = b - a;
  const float t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-20f), 0.f, 1.f);
  return (p - a - t * ab).norm();
}

double to_triangle(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f n = (b - a).cross(c - a);
  const bool above = (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
                     (a - c).cross(p - c).dot(n) >= 0;
  if (above && n.norm() > 0) return std::abs((p - a).dot(n)) / n.norm();
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

/// The box around the vertices that the triangles use.
Eigen::AlignedBox3f box_of(const Eigen::Matrix3Xf& vertices, const Eigen::Matrix3Xi& triangles) {
  Eigen::AlignedBox3f box;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k) box.extend(Vector3f(vertices.col(triangles(k, t))));
  return box;
}

}  // namespace

double winding_number(const Vector3f& point, const Eigen::Matrix3Xf& vertices,
                      const Eigen::Matrix3Xi& triangles) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    sum += solid_angle(vertices.col(triangles(0, t)) - point, vertices.col(triangles(1, t)) - point,
                       vertices.col(triangles(2, t)) - point);
  return sum / (4 * std::numbers::pi);
}

double distance(const Vector3f& point, const Eigen::Matrix3Xf& vertices,
                const Eigen::Matrix3Xi& triangles) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    least =
        std::min(least, to_triangle(point, vertices.col(triangles(0, t)),
                                    vertices.col(triangles(1, t)), vertices.col(triangles(2, t))));
  return least;
}

double penetration(const Eigen::Matrix3Xf& points, const Eigen::Matrix3Xf& vertices,
                   const Eigen::Matrix3Xi& triangles) {
  const Eigen::AlignedBox3f box = box_of(vertices, triangles);
  double deepest = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3f p = points.col(i);
    if (!box.contains(p) || winding_number(p, vertices, triangles) < 0.5) continue;
    deepest = std::max(deepest, distance(p, vertices, triangles));
  }
  return deepest;
}

double clearance(const Eigen::Matrix3Xf& points, const Eigen::Matrix3Xf& vertices,
                 const Eigen::Matrix3Xi& triangles) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    least = std::min(least, distance(points.col(i), vertices, triangles));
  return least;
}

}  // namespace hypotrack::test
