#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the world point nearest to the rays of two pixels, metres. NaN if the rays are parallel
/// or nearest to each other behind a camera.
Eigen::Vector3d triangulate(const Camera& a, const Eigen::Vector2d& in_a, const Camera& b,
                            const Eigen::Vector2d& in_b);

}  // namespace internal
}  // namespace hypotrack
