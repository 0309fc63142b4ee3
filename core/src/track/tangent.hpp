#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the rotation by a rotation vector, whose length is the angle.
Eigen::Quaterniond rotation_exp(const Eigen::Vector3d& vector);

/// Returns the rotation vector of a unit quaternion, the shorter way round.
Eigen::Vector3d rotation_log(const Eigen::Quaterniond& rotation);

/// Computes the difference of two normalised states. It has for each model the difference of
/// positions, the rotation vector v with from * exp(v) = to, and the differences of angles. It is
/// one number shorter per model than a state.
Eigen::VectorXd difference(const Scene& scene, const Eigen::VectorXd& from,
                           const Eigen::VectorXd& to);

/// Returns the normalised state that a difference leads to. Clamps joints to the models' bounds.
Eigen::VectorXd moved(const Scene& scene, const Eigen::VectorXd& from,
                      const Eigen::VectorXd& difference);

/// A range of a difference: a model's position, its rotation vector (`quaternion`), or neighbouring
/// angles or lengths.
struct TangentPart {
  ParameterKind kind = ParameterKind::position;
  Eigen::Index first = 0;
  Eigen::Index size = 0;
};

/// Returns all parts of a difference, in order. A rigid model has no part for joints.
std::vector<TangentPart> tangent_parts(const Scene& scene);

}  // namespace internal
}  // namespace hypotrack
