#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/exported.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether a model has a pose and nothing else.
bool is_rigid(const Scene::Item& item);

/// Returns the pose of a model of a scene in a state.
Eigen::Isometry3d pose_of(const Scene::Item& item, const Eigen::VectorXd& state);
/// Writes the pose of a model into a state.
void set_pose(const Scene::Item& item, const Eigen::Isometry3d& pose, Eigen::VectorXd& state);

}  // namespace internal
}  // namespace hypotrack
