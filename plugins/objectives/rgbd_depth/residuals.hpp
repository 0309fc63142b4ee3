#pragma once

#include <span>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "pixel_penalties.hpp"

namespace hypotrack::rgbd_depth {

/// Returns uncovered_residual() of every pixel.
PixelPlane<float> uncovered_residuals(const PixelPlane<float>& observed,
                                      const PixelPenalties& penalties);

/// Writes the residual of every pixel of the tile, rows without gaps: sqrt(wrong) depth_residual()
/// where it is covered, `uncovered` elsewhere. SIMD, as compare(). Distances are in metres.
void write_residuals(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                     const PixelPenalties& penalties, const PixelPlane<float>& uncovered,
                     std::span<float> residuals);

}  // namespace hypotrack::rgbd_depth
