#pragma once

#include <Eigen/Geometry>
#include <span>

#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {

/// Where a scene lies in the foreground masks of a frame.
enum class OnForeground {
  unknown,   ///< no view has a mask
  nowhere,   ///< it covers no foreground pixel of any mask
  in_parts,  ///< it does, but none of its points lies on the foreground of all masks
  yes,       ///< one of its points does, whatever hides it
};

/// The scene is in the frame that `world_from_scene` leaves. Looks at the centres of pixels. Lens
/// distortion moves corners of triangles; their edges stay straight.
OnForeground on_foreground(const PosedScene& scene, const Eigen::Isometry3d& world_from_scene,
                           std::span<const Camera> cameras, std::span<const View> views);

}  // namespace hypotrack
