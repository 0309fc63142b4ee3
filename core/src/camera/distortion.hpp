#pragma once

#include <array>

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

}  // namespace hypotrack
