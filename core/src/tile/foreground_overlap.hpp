#pragma once

#include <Eigen/Geometry>
#include <span>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Overlap of a scene with the foreground masks of a frame.
enum class ForegroundOverlap {
  unknown,   ///< no view has a mask
  nowhere,   ///< the scene covers no foreground pixel of any mask
  in_parts,  ///< it covers some, but no scene point is on the foreground of all masks
  yes,       ///< a scene point is on the foreground of all masks; occlusion is ignored
};

/// Tests where a scene lies in the foreground masks, at pixel centres. `world_from_scene` maps the
/// posed scene's frame to the world. Lens distortion moves triangle corners; edges stay straight.
ForegroundOverlap foreground_overlap(const PosedScene& scene,
                                     const Eigen::Isometry3d& world_from_scene,
                                     std::span<const Camera> cameras, std::span<const View> views);

}  // namespace internal
}  // namespace hypotrack
