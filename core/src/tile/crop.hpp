#pragma once

#include <span>
#include <vector>

#include "base/exported.hpp"
#include "camera/rectification.hpp"
#include "hypotrack/observation.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the cameras of size x size pixel tiles around bounds. The margin on each side is
/// `padding` times the larger extent. No tile is wider than `largest_focal` pixels at z = 1. Tiles
/// of a rectified pair share rows and scale.
std::vector<TileCamera> crop(std::span<const Bounds> around, const IdealRig& rig, int size,
                             double padding, double largest_focal);

}  // namespace internal
}  // namespace hypotrack
