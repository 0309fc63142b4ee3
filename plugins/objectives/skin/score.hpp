#pragma once

#include <cstdint>

#include "hypotrack/objective.hpp"
#include "hypotrack/view_pixels.hpp"

namespace hypotrack::skin {

/// Sum of change_if_covered() over the pixels that a hypothesis covers. `foreground`
/// (ViewForeground::pixels) has the tile's size. SIMD, for the best instruction set that this
/// machine (or hwy::SetSupportedTargetsForTest) offers; they differ by rounding only.
double sum_covered(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile, float spill);

/// The instruction sets that sum_covered() is compiled for, as Highway's bits.
std::int64_t compiled_targets();

}  // namespace hypotrack::skin
