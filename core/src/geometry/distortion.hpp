#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {

/// The 4, 5 or 8 coefficients of a lens, zero-filled to 8: k1 k2 p1 p2 k3 k4 k5 k6, or k1 .. k4.
using DistortionCoefficients = std::array<double, 8>;

DistortionCoefficients distortion_coefficients(const Camera& camera);

/// The largest distance from the optical axis, as r = tan(angle), up to which the lens maps
/// outwards points to outwards pixels. Beyond it a polynomial fitted to the image folds back, and
/// directions that the camera never saw land inside the picture. Infinite where it never folds.
HYPOTRACK_API double monotonic_radius(const Camera& camera);

/// OpenCV's radial (rational) and tangential model on normalised image coordinates; see "Camera
/// Calibration and 3D Reconstruction" in OpenCV's documentation. T is a scalar or an Eigen array.
template <class T, class Scalar>
void distort_brown(const std::array<Scalar, 8>& k, const T& x, const T& y, T& xd, T& yd) {
  const Scalar one(1);
  const Scalar two(2);
  const T r2 = x * x + y * y;
  const T xy2 = two * x * y;
  const T radial =
      (one + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (one + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  xd = x * radial + k[2] * xy2 + k[3] * (r2 + two * x * x);
  yd = y * radial + k[2] * (r2 + two * y * y) + k[3] * xy2;
}

/// OpenCV's fisheye model (Kannala and Brandt, 2006): the factor on normalised coordinates at
/// distance r from the axis.
template <class Scalar>
Scalar fisheye_factor(const std::array<Scalar, 8>& k, Scalar r) {
  if (r < Scalar(1e-8)) return Scalar(1);
  const Scalar t = std::atan(r);
  const Scalar t2 = t * t;
  return t * (Scalar(1) + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r;
}

}  // namespace hypotrack
