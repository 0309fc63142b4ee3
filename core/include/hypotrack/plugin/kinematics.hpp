#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Returns world_from_model for a model's pose parameters. The quaternion need not be normalised; a
/// zero quaternion gives the identity rotation.
HYPOTRACK_API Eigen::Isometry3d world_from_model(std::span<const double> parameters);

/// Returns model_from_bone of every bone at the bind pose.
HYPOTRACK_API std::vector<Eigen::Isometry3d> bind_transforms(const ModelData& data);

/// Returns world_from_bone of every bone for one parameter vector (forward kinematics).
HYPOTRACK_API std::vector<Eigen::Isometry3d> world_from_bones(const ModelData& data,
                                                              std::span<const double> parameters);

/// Returns the world positions of a model's landmarks, 3xL, metres. Calls Model::pose() if the
/// model poses itself.
HYPOTRACK_API Eigen::Matrix3Xd posed_landmarks(const Model& model,
                                               std::span<const double> parameters);

/// Returns the derivatives of a model's landmarks by its parameters: 3 rows (x, y, z) per landmark,
/// one column per parameter. Along the quaternion, only derivatives within the unit sphere hold.
/// Throws Error if the model poses itself.
HYPOTRACK_API Eigen::MatrixXd landmark_derivatives(const Model& model,
                                                   std::span<const double> parameters);

/// Returns the world positions of a model's vertices by linear blend skinning, 3xV, metres. The
/// fast implementations are tested against this reference.
HYPOTRACK_API Eigen::Matrix3Xf posed_vertices(const Model& model,
                                              std::span<const double> parameters);

}  // namespace hypotrack
