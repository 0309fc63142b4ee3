#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// A rigid model that moves with the one that is looked for, as what a hand holds.
struct Held {
  std::size_t model;
  Eigen::Isometry3d pose;  ///< in the frame of the one that is looked for
};

/// Pose of a model of a scene in a state.
HYPOTRACK_API Eigen::Isometry3d pose_of(const Scene::Item& item, const Eigen::VectorXd& state);
/// Puts a model there.
HYPOTRACK_API void set_pose(const Scene::Item& item, const Eigen::Isometry3d& pose,
                            Eigen::VectorXd& state);

/// The state `before` with one model moved as another has moved since.
HYPOTRACK_API Eigen::VectorXd moved_with(const Scene& scene, std::size_t model, std::size_t other,
                                         const Eigen::VectorXd& before, const Eigen::VectorXd& now);

/// Says of each model whether it is rigid and so near an articulated one that that may hold it.
HYPOTRACK_API std::vector<bool> held_by(const Scene& scene, std::size_t model,
                                        const Eigen::VectorXd& state);

/// How far models that others held in `before` have moved in them since: a sum over the models with
/// `shown` of mean distances of landmarks, metres.
HYPOTRACK_API double moved_in_hand(const Scene& scene, const Eigen::VectorXd& before,
                                   const Eigen::VectorXd& now, const std::vector<bool>& shown);

}  // namespace hypotrack
