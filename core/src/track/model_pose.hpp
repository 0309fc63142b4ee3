#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether a model has a pose and nothing else.
inline bool is_rigid(const Scene::Item& item) { return item.model->dimension() == kPoseSize; }

/// Returns the pose of a model of a scene in a state.
inline Eigen::Isometry3d pose_of(const Scene::Item& item, const Eigen::VectorXd& state) {
  const auto pose = state.segment<kPoseSize>(item.offset);
  Eigen::Isometry3d out(Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]));
  out.pretranslate(Eigen::Vector3d(pose.head<3>()));
  return out;
}

/// Writes the pose of a model into a state.
inline void set_pose(const Scene::Item& item, const Eigen::Isometry3d& pose,
                     Eigen::VectorXd& state) {
  const Eigen::Quaterniond q(pose.linear());
  state.segment<kPoseSize>(item.offset) << pose.translation(), q.w(), q.x(), q.y(), q.z();
}

}  // namespace internal
}  // namespace hypotrack
