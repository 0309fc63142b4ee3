#pragma once

#include <array>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A lens's 4, 5 or 8 coefficients, zero-filled to 8: k1 k2 p1 p2 k3 k4 k5 k6, or k1 .. k4.
using DistortionCoefficients = std::array<double, 8>;

DistortionCoefficients distortion_coefficients(const Camera& camera);

/// Returns the largest distance from the optical axis, r = tan(angle), up to which distortion is
/// monotonic. Beyond it the fitted polynomial folds back, so that rays which the camera never saw
/// map into the image. Infinite if it never folds.
double monotonic_radius(const Camera& camera);

}  // namespace internal
}  // namespace hypotrack
