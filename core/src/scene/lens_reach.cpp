#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "camera/lens/distort.hpp"
#include "camera/lens/distortion.hpp"
#include "camera/lens/interval_number.hpp"
#include "scene/visible_share.hpp"

namespace hypotrack::internal {
namespace {

struct Rectangle {
  IntervalNumber x, y;
};

/// Returns the bounds as the rotated camera sees them on its plane z = 1, or nothing if it looks
/// too far aside. With d = R (u, v, 1), x is dx/dz. Along any line this is a quotient of linear
/// functions, monotonic while dz is positive. So are the rectangle's sides; the extremes and the
/// smallest dz are at corners.
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
  return Rectangle{IntervalNumber::around(x), IntervalNumber::around(y)};
}

/// Returns the interval of the squares of an interval's numbers.
IntervalNumber square(IntervalNumber a) {
  const double low = a.low * a.low;
  const double high = a.high * a.high;
  const bool has_zero = a.low <= 0 && a.high >= 0;
  return {has_zero ? 0 : std::min(low, high), std::max(low, high)};
}

/// Returns the interval of fisheye factors. atan(r) / r decreases with r; the rest of the factor is
/// a polynomial of the angle.
IntervalNumber fisheye_factors(const double* k, IntervalNumber r2) {
  const IntervalNumber r{std::sqrt(r2.low), std::sqrt(r2.high)};
  const IntervalNumber angle{std::atan(r.low), std::atan(r.high)};
  const auto per_radius = [](double a, double radius) { return radius < 1e-8 ? 1.0 : a / radius; };
  const IntervalNumber flat{per_radius(angle.high, r.high), per_radius(angle.low, r.low)};
  return flat * fisheye_polynomial(k, square(angle));
}

Rectangle distorted(const Camera& camera, const Rectangle& ideal) {
  const DistortionCoefficients k = distortion_coefficients(camera);
  switch (camera.distortion_model) {
    case DistortionModel::none:
      break;
    case DistortionModel::brown: {
      Rectangle out = ideal;
      if (has_prisms_or_tilt(camera))
        distort_full(k.data(), ideal.x, ideal.y, out.x, out.y);
      else
        distort_brown(k.data(), ideal.x, ideal.y, out.x, out.y);
      return out;
    }
    case DistortionModel::fisheye: {
      const IntervalNumber factor = fisheye_factors(k.data(), square(ideal.x) + square(ideal.y));
      return {ideal.x * factor, ideal.y * factor};
    }
  }
  return ideal;
}

/// Returns true if an interval lies at least one pixel inside the image. The margin far exceeds
/// rounding: single precision, used for bounds and shares, moves a point by about 1e-6 of the
/// image's width.
bool inside(IntervalNumber pixels, int size) {
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

}  // namespace hypotrack::internal
