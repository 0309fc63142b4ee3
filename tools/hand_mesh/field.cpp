#include "field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Farther than this outside of its bounding sphere a limb only says how far that is.
constexpr double kFar = 16.0;

Vector3d extents(const ProfileKnot& k) { return {k.width, k.palmar, k.dorsal}; }

/// Nearest point of a triangle, by the regions of its edges and corners (Ericson, "Real-Time
/// Collision Detection", 2005, section 5.1.5).
Vector3d nearest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                             const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double scale = 1.0 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

}  // namespace

Limb::Limb(const Isometry3d& hand_from_limb, double length, std::vector<ProfileKnot> profile,
           double start_cap, double end_cap, double exponent)
    : limb_from_hand_(hand_from_limb.inverse()),
      length_(length),
      profile_(std::move(profile)),
      start_cap_(start_cap),
      end_cap_(end_cap),
      exponent_(exponent) {
  double widest = 0;
  for (const ProfileKnot& k : profile_) widest = std::max(widest, extents(k).maxCoeff());
  center_ = hand_from_limb * Vector3d(0, 0.5 * length, 0);
  radius_ = std::hypot(0.5 * length + std::max(start_cap, end_cap), widest);
}

/// Cubic Hermite interpolation with the slopes of Catmull and Rom; level at both ends, where the
/// caps go on.
Vector3d Limb::section(double t) const {
  const int last = static_cast<int>(profile_.size()) - 1;
  int i = 0;
  while (i + 1 < last && t > profile_[i + 1].t) ++i;
  if (last == 0) return extents(profile_[0]);
  const auto slope = [&](int k) -> Vector3d {
    if (k == 0 || k == last) return Vector3d::Zero();
    return (extents(profile_[k + 1]) - extents(profile_[k - 1])) /
           (profile_[k + 1].t - profile_[k - 1].t);
  };
  const double h = profile_[i + 1].t - profile_[i].t;
  const double u = (t - profile_[i].t) / h;
  const double v = 1 - u;
  return (1 + 2 * u) * v * v * extents(profile_[i]) + h * u * v * v * slope(i) +
         u * u * (3 - 2 * u) * extents(profile_[i + 1]) - h * u * u * v * slope(i + 1);
}

double Limb::operator()(const Vector3d& p) const {
  const double away = (p - center_).norm() - radius_;
  if (away > kFar) return away;
  const Vector3d local = limb_from_hand_ * p;
  const double along = std::clamp(local.y(), 0.0, length_);
  const Vector3d size = section(length_ > 0 ? along / length_ : 0.0);
  const double beyond = local.y() - along;
  const double x = std::abs(local.x()) / size[0];
  const double z = std::abs(local.z()) / (local.z() > 0 ? size[1] : size[2]);
  const double y = beyond / (beyond > 0 ? end_cap_ : start_cap_);
  double around = x * x + z * z;
  if (exponent_ != 2.0)
    around = std::pow(std::pow(x, exponent_) + std::pow(z, exponent_), 2.0 / exponent_);
  const double q = std::sqrt(around + y * y);
  const double r = std::sqrt(local.x() * local.x() + local.z() * local.z() + beyond * beyond);
  return q > 1e-9 ? r * (1 - 1 / q) : -size.minCoeff();
}

Limb ellipsoid(const Isometry3d& hand_from_ellipsoid, const Vector3d& h) {
  return Limb(hand_from_ellipsoid, 0.0, {{0.0, h.x(), h.z(), h.z()}}, h.y(), h.y());
}

double rounded_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                        double radius) {
  return (p - nearest_on_triangle(p, a, b, c)).norm() - radius;
}

double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - 0.25 * blend * h * h;
}

double smooth_max(double a, double b, double blend) { return -smooth_min(-a, -b, blend); }

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace hypotrack::hand_mesh
