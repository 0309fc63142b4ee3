#include "scene/lens_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "camera/distort.hpp"
#include "camera/distortion.hpp"
#include "camera/interval.hpp"

namespace hypotrack {
namespace {

struct Rectangle {
  Interval x, y;
};

/// What the plane z = 1 of the turned camera shows of bounds. With d = R (u, v, 1), x is dx/dz: a
/// quotient of functions that are linear along any line, monotonic along it while dz stays
/// positive. So is dx/dz along the rectangle's sides: extremes lie at corners, and so does the
/// smallest dz. Nothing where the camera looks too far aside.
std::optional<Rectangle> turned(const Bounds& bounds, const Eigen::Matrix3d& camera_from_ideal) {
  constexpr double kLeastAhead = 0.05;
  const std::array<Eigen::Vector3d, 4> corners = {{{bounds.x0, bounds.y0, 1},
                                                   {bounds.x1, bounds.y0, 1},
                                                   {bounds.x0, bounds.y1, 1},
                                                   {bounds.x1, bounds.y1, 1}}};
  std::array<double, 4> x{};
  std::array<double, 4> y{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d d = camera_from_ideal * corners[i];
    if (!(d.z() > kLeastAhead)) return std::nullopt;
    x[i] = d.x() / d.z();
    y[i] = d.y() / d.z();
  }
  return Rectangle{Interval::around(x), Interval::around(y)};
}

/// The squares of an interval's numbers.
Interval square(Interval a) {
  const double low = a.low * a.low;
  const double high = a.high * a.high;
  const bool has_zero = a.low <= 0 && a.high >= 0;
  return {has_zero ? 0 : std::min(low, high), std::max(low, high)};
}

/// atan(r) / r falls as r grows; the rest of the fisheye's factor is a polynomial of the angle.
Interval fisheye_factors(const double* k, Interval r2) {
  const Interval r{std::sqrt(r2.low), std::sqrt(r2.high)};
  const Interval angle{std::atan(r.low), std::atan(r.high)};
  const auto per_radius = [](double a, double radius) { return radius < 1e-8 ? 1.0 : a / radius; };
  const Interval flat{per_radius(angle.high, r.high), per_radius(angle.low, r.low)};
  return flat * fisheye_polynomial(k, square(angle));
}

Rectangle distorted(const Camera& camera, const Rectangle& ideal) {
  const DistortionCoefficients k = distortion_coefficients(camera);
  switch (camera.distortion_model) {
    case DistortionModel::none:
      break;
    case DistortionModel::brown: {
      Rectangle out = ideal;
      distort_brown(k.data(), ideal.x, ideal.y, out.x, out.y);
      return out;
    }
    case DistortionModel::fisheye: {
      const Interval factor = fisheye_factors(k.data(), square(ideal.x) + square(ideal.y));
      return {ideal.x * factor, ideal.y * factor};
    }
  }
  return ideal;
}

/// A pixel within an image's ends. It is far more than all rounding: that of single precision, in
/// which bounds and shares are computed, moves a point by some 1e-6 of the image's width.
bool inside(Interval pixels, int size) {
  constexpr double kMargin = 1.0;
  return pixels.low >= kMargin - 0.5 && pixels.high <= size - 0.5 - kMargin;
}

}  // namespace

bool surely_shown(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal,
                  const Bounds& bounds) {
  const std::optional<Rectangle> ideal = turned(bounds, camera_from_ideal);
  if (!ideal) return false;
  const Rectangle image = distorted(camera, *ideal);
  return inside(image.x * camera.fx + camera.cx, camera.width) &&
         inside(image.y * camera.fy + camera.cy, camera.height);
}

}  // namespace hypotrack
