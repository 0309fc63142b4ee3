#pragma once

#include <Eigen/Geometry>
#include <span>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/config.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads `{palm: DIRECTION, fingers: DIRECTION}`, the rotation of a hand (world_from_model). A
/// direction is [x, y, z] in the world or a word: to_camera, away, left, right, up, down, as seen
/// from the first camera (none: along the world's axes). Throws ConfigError if the model is no hand
/// or the directions are more than 30 degrees from perpendicular.
Eigen::Quaterniond read_hand_rotation(const ConfigNode& node, const Scene::Item& item,
                                      std::span<const Camera> cameras);

}  // namespace internal
}  // namespace hypotrack
