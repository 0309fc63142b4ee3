#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Skins a mesh's vertices by linear blend skinning: 3xV, metres, in the frame of the given bones.
/// Computes in double precision and rounds at the end.
Eigen::Matrix3Xf skin(const ModelData& data, const Mesh& mesh,
                      std::span<const Eigen::Isometry3d> world_from_bone);

/// Returns the vertices of a mesh of a model, as posed_vertices() does those of its own. A model
/// that poses itself has no other.
Eigen::Matrix3Xf posed_vertices(const Model& model, const Mesh& mesh,
                                std::span<const double> parameters);

/// Returns the landmarks of posed bones, 3xL, metres.
Eigen::Matrix3Xd place_landmarks(const ModelData& data,
                                 std::span<const Eigen::Isometry3d> world_from_bone);

}  // namespace internal
}  // namespace hypotrack
