#pragma once

#include <cstdint>
#include <span>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "pixel_penalties.hpp"

namespace hypotrack::rgbd_depth {

/// Sums over the pixels of one view that a hypothesis covers.
struct Agreement {
  double closeness = 0;  ///< of d_M - min(|o_d - r_d|, d_M) where foreground was measured, metres
  std::int64_t matched = 0;  ///< number with o_s and r_m
  std::int64_t beyond = 0;   ///< number with r_m but not o_s
};

/// Sums the agreement over the covered pixels of a tile. `observed` (foreground-inl.hpp) has the
/// tile's size. Uses the best SIMD instruction set of this machine (or
/// hwy::SetSupportedTargetsForTest); they differ by rounding only. Distances are in metres.
Agreement compare(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                  float d_match);

/// Returns the instruction sets that compare() is compiled for, as Highway's bits.
std::int64_t compiled_targets();

/// Returns uncovered_residual() of every pixel.
PixelPlane<float> uncovered_residuals(const PixelPlane<float>& observed,
                                      const PixelPenalties& penalties);

/// Writes the residual of every pixel of the tile, rows without gaps: sqrt(wrong) depth_residual()
/// where it is covered, `uncovered` elsewhere. SIMD, as compare(). Distances are in metres.
void write_residuals(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                     const PixelPenalties& penalties, const PixelPlane<float>& uncovered,
                     std::span<float> residuals);

}  // namespace hypotrack::rgbd_depth
