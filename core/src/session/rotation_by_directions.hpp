#pragma once

#include <Eigen/Geometry>
#include <span>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads where two of a model's directions() point, `{NAME: DIRECTION, NAME: DIRECTION}`, and
/// returns its rotation (world_from_model). A DIRECTION is [x, y, z] in the world or a word:
/// to_camera, away, left, right, up, down, as seen from the first camera (none: along the world's
/// axes). Throws ConfigError if the model has no such directions or they are given more than 30
/// degrees from perpendicular.
Eigen::Quaterniond rotation_by_directions(const ConfigNode& node, const Scene::Item& item,
                                          std::span<const Camera> cameras);

}  // namespace internal
}  // namespace hypotrack
