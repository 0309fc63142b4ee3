#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// The rotation by a vector: its length is the angle.
HYPOTRACK_API Eigen::Quaterniond rotation_exp(const Eigen::Vector3d& vector);

/// The vector of a unit quaternion's rotation, the shorter way round.
HYPOTRACK_API Eigen::Vector3d rotation_log(const Eigen::Quaterniond& rotation);

/// What leads from one normalised state to another, model by model: the difference of positions,
/// the rotation vector v with from * exp(v) = to, and the differences of angles. One number shorter
/// per model than a state.
HYPOTRACK_API Eigen::VectorXd difference(const Scene& scene, const Eigen::VectorXd& from,
                                         const Eigen::VectorXd& to);

/// The normalised state that a difference leads to. Angles stay within the models' bounds.
HYPOTRACK_API Eigen::VectorXd moved(const Scene& scene, const Eigen::VectorXd& from,
                                    const Eigen::VectorXd& difference);

/// Numbers of a difference that are of one kind: a model's position, its rotation vector
/// (`quaternion`) or its angles.
struct TangentPart {
  ParameterKind kind = ParameterKind::position;
  Eigen::Index first = 0;
  Eigen::Index size = 0;
};

/// All of them, in their order. A rigid model has none for angles.
HYPOTRACK_API std::vector<TangentPart> tangent_parts(const Scene& scene);

}  // namespace hypotrack
