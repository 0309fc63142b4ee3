#pragma once

#include <Eigen/Core>

namespace hypotrack::bvh {

/// Returns the angles z, x, y (radians) with rotation = Rz(z) Rx(x) Ry(y). Of all that give the
/// rotation, takes those nearest to `previous`, so that a curve of them has no jumps.
Eigen::Vector3d zxy_angles(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& previous);

}  // namespace hypotrack::bvh
