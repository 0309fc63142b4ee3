#pragma once

#include <array>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A lens's coefficients, zero-filled: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4, or k1 .. k4 of a
/// fisheye, then the matrix of a tilted sensor (distort.hpp).
using DistortionCoefficients = std::array<double, 19>;

DistortionCoefficients distortion_coefficients(const Camera& camera);

/// Returns whether a brown lens has thin prisms or a tilted sensor: 12 or 14 coefficients.
bool has_prisms_or_tilt(const Camera& camera);

/// Returns the largest distance from the optical axis, r = tan(angle), up to which distortion is
/// monotonic. Beyond it the fitted polynomial folds back, so that rays which the camera never saw
/// map into the image. Infinite if it never folds.
double monotonic_radius(const Camera& camera);

}  // namespace internal
}  // namespace hypotrack
