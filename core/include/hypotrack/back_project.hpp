#pragma once

#include <Eigen/Core>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {

/// Computes the rays of pixels (2xN), lens distortion removed: points (3xN) of depth 1 in the
/// camera's frame. NaN where the lens model cannot be inverted.
HYPOTRACK_API Eigen::Matrix3Xd back_project(const Camera& camera, const Eigen::Matrix2Xd& pixels);

}  // namespace hypotrack
