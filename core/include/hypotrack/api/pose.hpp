#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {

/// Reads a pose from YAML and returns `base` with the given values replaced:
///
///   box:                                    # a model of the scene
///     position_mm: [0, 20, 500]             # x y z in the world
///     rotation_deg: [0, 180, 0]             # rotation vector: axis times angle
///     quaternion: [1, 0, 0, 0]              # instead of rotation_deg: w x y z
///     rotation: {front: to_camera, lid: up} # instead of it: where its directions() point
///     angles_deg: {hinge: 30}               # any joint angles of the model
///     lengths_mm: {drawer: 80}              # any lengths of joints that slide
///
/// Every key is optional. A direction in `rotation` is [x, y, z] in the world or to_camera, away,
/// left, right, up or down, as the first of `cameras` sees it (none: along the world's axes).
/// Throws ConfigError with file:line:column on unknown models, keys and angles, wrong lengths, zero
/// quaternions, directions that are not perpendicular and joints outside the model's bounds.
HYPOTRACK_API Eigen::VectorXd read_pose(const ConfigNode& node, const Scene& scene,
                                        Eigen::VectorXd base, std::span<const Camera> cameras = {});

/// Writes the poses of some models (one flag each) as YAML, which read_pose() reads back within
/// 0.001 mm and degrees. Joints at rest are left out.
HYPOTRACK_API std::string pose_yaml(const Scene& scene, const Eigen::VectorXd& state,
                                    const std::vector<bool>& models);

}  // namespace hypotrack
