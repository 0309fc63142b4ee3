#pragma once

#include <Eigen/Geometry>
#include <span>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Near clipping distance in metres: a projection has no meaning at the camera's centre.
inline constexpr double kNearest = 1e-3;

/// Returns the bounding box of vertices (3xV each, world) in the plane z = 1 of a camera:
/// (x / z, y / z). Empty if nothing is in front of the camera; infinite if some of them are at or
/// behind it.
Eigen::AlignedBox2d extent_of(std::span<const Eigen::Matrix3Xf> vertices,
                              const Eigen::Isometry3d& camera_from_world);

}  // namespace internal
}  // namespace hypotrack
