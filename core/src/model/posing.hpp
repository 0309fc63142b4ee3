#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hypotrack/kinematics.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// Vertices moved by linear blend skinning, 3xV, metres, in the frame that the bones are given in.
/// Computed in double precision, rounded at the end.
Eigen::Matrix3Xf skin(const ModelData& data, std::span<const Eigen::Isometry3d> world_from_bone);

/// Landmarks of posed bones, 3xL, metres.
Eigen::Matrix3Xd place_landmarks(const ModelData& data,
                                 std::span<const Eigen::Isometry3d> world_from_bone);

}  // namespace hypotrack
