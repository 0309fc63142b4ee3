#pragma once

#include <array>

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/observation.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack::cuda {

/// FrameLayout::work_ends.
using WorkEnds = std::array<float, kMostBands + 1>;

/// Every row takes the same.
HYPOTRACK_API WorkEnds even_work();

/// That of hypotheses like a posed scene, as the first camera sees it in its tile: a row takes as
/// much as it has pixels of the surface and triangles, each of which takes as much as some pixels,
/// and half as much as an average row has of the surface. From a sample of the surface.
WorkEnds work_of(const PosedScene& scene, const TileCamera& tile);

}  // namespace hypotrack::cuda
