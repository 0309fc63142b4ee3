#pragma once

#include <cstdint>
#include <span>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::skin {

/// Returns the sum of change_if_covered() over the pixels that a hypothesis covers. `foreground`
/// (ViewForeground::pixels) has the tile's size. Uses the best SIMD instruction set of this machine
/// (or hwy::SetSupportedTargetsForTest); they differ by rounding only.
double sum_covered(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile, float spill);

/// Returns the instruction sets that sum_covered() is compiled for, as Highway's bits.
std::int64_t compiled_targets();

/// Returns sqrt(share P) of every pixel: the residuals of a hypothesis that covers nothing.
/// `foreground` is ViewForeground::pixels.
PixelPlane<float> uncovered_residuals(const PixelPlane<std::uint32_t>& foreground, float share);

/// Writes the residual of every pixel of the tile, rows without gaps: sqrt(share spill (1 - P))
/// where it is covered, `uncovered` elsewhere. Returns the result of sum_covered(). SIMD, as
/// sum_covered().
double write_residuals(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile,
                       float spill, float share, const PixelPlane<float>& uncovered,
                       std::span<float> residuals);

}  // namespace hypotrack::skin
