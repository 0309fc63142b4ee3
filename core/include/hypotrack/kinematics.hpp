#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// world_from_model of a model's pose parameters. The quaternion need not be normalised; a zero one
/// is the identity.
HYPOTRACK_API Eigen::Isometry3d world_from_model(std::span<const double> parameters);

/// model_from_bone of every bone at the bind pose.
HYPOTRACK_API std::vector<Eigen::Isometry3d> bind_transforms(const ModelData& data);

/// world_from_bone of every bone for one parameter vector (forward kinematics).
HYPOTRACK_API std::vector<Eigen::Isometry3d> world_from_bones(const ModelData& data,
                                                              std::span<const double> parameters);

/// World positions of a model's landmarks, 3xL, metres; asks the model where it poses itself.
HYPOTRACK_API Eigen::Matrix3Xd posed_landmarks(const Model& model,
                                               std::span<const double> parameters);

/// World positions of a model's vertices by linear blend skinning, 3xV, metres: the plain reference
/// that the fast paths are tested against.
HYPOTRACK_API Eigen::Matrix3Xf posed_vertices(const Model& model,
                                              std::span<const double> parameters);

}  // namespace hypotrack
