#pragma once

#include <Eigen/Core>

#include "hypotrack/camera.hpp"

namespace hypotrack {

/// Returns the world point nearest to the rays of two pixels, metres. NaN if the rays are parallel
/// or nearest to each other behind a camera.
Eigen::Vector3d triangulate(const Camera& a, const Eigen::Vector2d& in_a, const Camera& b,
                            const Eigen::Vector2d& in_b);

}  // namespace hypotrack
