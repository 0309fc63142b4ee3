#pragma once

#include <cstdint>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::skin {

/// Returns the sum of change_if_covered() over the pixels that a hypothesis covers. `foreground`
/// (ViewForeground::pixels) has the tile's size. Uses the best SIMD instruction set of this machine
/// (or hwy::SetSupportedTargetsForTest); they differ by rounding only.
double sum_covered(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile, float spill);

/// Returns the instruction sets that sum_covered() is compiled for, as Highway's bits.
std::int64_t compiled_targets();

}  // namespace hypotrack::skin
