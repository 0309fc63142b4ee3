#pragma once

#include <Eigen/Core>

#include "hypotrack/config.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Reads a pose from YAML and returns `base` with the given values replaced:
///
///   hand:                                   # a model of the scene
///     position_mm: [0, 20, 500]             # x y z in the world
///     rotation_deg: [0, 180, 0]             # rotation vector: axis times angle
///     quaternion: [1, 0, 0, 0]              # instead of rotation_deg: w x y z
///     angles_deg: {index_flexion_1: 30}     # any joint angles of the model
///
/// Every key is optional. Throws ConfigError with file:line:column on unknown models, keys and
/// angles, wrong lengths, zero quaternions and angles outside the model's bounds.
HYPOTRACK_API Eigen::VectorXd read_pose(const ConfigNode& node, const Scene& scene,
                                        Eigen::VectorXd base);

/// Sets joint angles of one model from a map of parameter names to degrees. Throws as read_pose().
HYPOTRACK_API void read_angles(const ConfigNode& node, const Scene::Item& item,
                               Eigen::Ref<Eigen::VectorXd> state);

}  // namespace hypotrack
