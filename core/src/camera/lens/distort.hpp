#pragma once

#include <cmath>

#include "base/exported.hpp"
#include "hypotrack/plugin/pixel.hpp"

/// Lens distortion formulas for CPU and CUDA, without Eigen and OpenCV.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Applies OpenCV's radial (rational) and tangential distortion to normalised image coordinates.
/// `k` holds k1 k2 p1 p2 k3 k4 k5 k6. T is a scalar, an Eigen array or an interval. Source: "Camera
/// Calibration and 3D Reconstruction" in OpenCV's documentation.
template <class T, class Scalar>
HYPOTRACK_PIXEL void distort_brown(const Scalar* k, const T& x, const T& y, T& xd, T& yd) {
  const Scalar one(1);
  const Scalar two(2);
  const T r2 = x * x + y * y;
  const T xy2 = two * x * y;
  const T radial =
      (one + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (one + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  xd = x * radial + k[2] * xy2 + k[3] * (r2 + two * x * x);
  yd = y * radial + k[2] * (r2 + two * y * y) + k[3] * xy2;
}

/// Applies distort_brown(), then thin prisms and the tilt of the sensor: `k` goes on with s1 s2 s3
/// s4 and h00 h01 h10 h11 h20 h21 h22, a matrix whose h02 and h12 are 0.
template <class T, class Scalar>
HYPOTRACK_PIXEL void distort_full(const Scalar* k, const T& x, const T& y, T& xd, T& yd) {
  distort_brown(k, x, y, xd, yd);
  const T r2 = x * x + y * y;
  const T xp = xd + r2 * (k[8] + k[9] * r2);
  const T yp = yd + r2 * (k[10] + k[11] * r2);
  const T z = k[16] * xp + k[17] * yp + k[18];
  xd = (k[12] * xp + k[13] * yp) / z;
  yd = (k[14] * xp + k[15] * yp) / z;
}

/// Returns the distorted angle from the axis divided by the angle t, given t^2. T is a scalar or an
/// interval.
template <class T, class Scalar>
HYPOTRACK_PIXEL T fisheye_polynomial(const Scalar* k, const T& t2) {
  return Scalar(1) + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])));
}

/// Returns the factor on normalised coordinates at distance r from the axis in OpenCV's fisheye
/// model (Kannala and Brandt, 2006). `k` holds k1 k2 k3 k4.
template <class Scalar>
HYPOTRACK_PIXEL Scalar fisheye_factor(const Scalar* k, Scalar r) {
  if (r < Scalar(1e-8)) return Scalar(1);
  const Scalar t = std::atan(r);
  return t * fisheye_polynomial(k, t * t) / r;
}

}  // namespace internal
}  // namespace hypotrack
