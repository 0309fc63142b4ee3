#pragma once

#include <array>

#include "geometry/posed_scene.hpp"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::cuda {

/// FrameLayout::work_ends.
using WorkEnds = std::array<float, kMostBands + 1>;

/// Every row takes the same.
HYPOTRACK_API WorkEnds even_work();

/// That of hypotheses like a posed scene, as the first camera sees it: a row takes as much as it
/// has of the surface, and half as much as an average row has. From a sample of the surface.
WorkEnds work_of(const PosedScene& scene);

}  // namespace hypotrack::cuda
