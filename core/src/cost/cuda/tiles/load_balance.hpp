#pragma once

#include <array>

#include "base/exported.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// The type of FrameLayout::work_ends.
using BandEnds = std::array<float, kMostBands + 1>;

/// Returns equal work for every row.
BandEnds even_bands();

/// Estimates the work per row of hypotheses like a posed scene in the first camera's tile, from a
/// sample of its triangles. A row's work is its surface pixels, a constant per triangle, and half
/// of the average row's pixels.
BandEnds bands_of_equal_work(const PosedScene& scene, const TileCamera& tile);

}  // namespace internal
}  // namespace hypotrack::cuda
