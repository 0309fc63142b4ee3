#pragma once

#include <Eigen/Core>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {

/// True only if the camera's image shows whatever an ideal camera at the same place sees within
/// bounds, the image's outermost pixel aside. False says nothing. `camera_from_ideal` is a
/// rotation.
HYPOTRACK_API bool surely_shown(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal,
                                const Bounds& bounds);

}  // namespace hypotrack
