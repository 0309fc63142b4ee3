#pragma once

#include <span>
#include <vector>

#include "camera/rectification.hpp"
#include "hypotrack/observation.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {

/// The tiles of size x size pixels around bounds, with a margin on each side as a share of the
/// larger extent, none wider than `largest_focal` pixels at z = 1. Tiles of a rectified pair share
/// rows and scale.
std::vector<TileCamera> crop(std::span<const Bounds> around, const IdealRig& rig, int size,
                             double padding, double largest_focal);

}  // namespace hypotrack
