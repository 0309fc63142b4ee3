#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/model_pose.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A rigid model that moves with the sought one, such as an object that it holds.
struct HeldModel {
  std::size_t model;
  Eigen::Isometry3d pose;  ///< in the frame of the sought model
};

/// Returns the state `before` with one model moved by the rigid motion of another from `before` to
/// `now`.
Eigen::VectorXd moved_with(const Scene& scene, std::size_t model, std::size_t other,
                           const Eigen::VectorXd& before, const Eigen::VectorXd& now);

/// Returns a flag for each model: whether it is rigid and near enough to an articulated `model` to
/// be held by it. All are false if `model` is rigid.
std::vector<bool> held_by(const Scene& scene, std::size_t model, const Eigen::VectorXd& state);

/// Returns how far held models have moved relative to their holders since `before`, in metres: the
/// sum, over the models with `shown`, of mean distances of landmarks.
double moved_while_held(const Scene& scene, const Eigen::VectorXd& before,
                        const Eigen::VectorXd& now, const std::vector<bool>& shown);

}  // namespace internal
}  // namespace hypotrack
