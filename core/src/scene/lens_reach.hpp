#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns true only if the camera's image surely shows everything within an ideal camera's bounds,
/// except the image's outermost pixel. False proves nothing. The ideal camera is at the same place;
/// `camera_from_ideal` is a rotation.
bool surely_shown(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal,
                  const Bounds& bounds);

}  // namespace internal
}  // namespace hypotrack
