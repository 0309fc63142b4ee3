#pragma once

#include <span>

#include "hypotrack/objective.hpp"
#include "hypotrack/view_pixels.hpp"

namespace hypotrack::rgbd_depth {

/// What a pixel adds to the objective near the observation: with F observed foreground pixels, one
/// that disagrees adds about d_M / F to D and 1 / (2 F) to S.
struct PixelPrices {
  float wrong = 0;   ///< covered by mistake, missed or d_M off: 100 d_M / F + lambda / (2 F)
  float hidden = 0;  ///< missed where the sensor had a hole: lambda / (2 F)
};

/// Residuals of a hypothesis that covers nothing: sqrt(wrong) where foreground was measured,
/// sqrt(hidden) where it was not, 0 elsewhere.
PixelPlane<float> uncovered_residuals(const PixelPlane<float>& observed, const PixelPrices& prices);

/// Writes the residual of every pixel of the tile, rows without gaps: sqrt(wrong) depth_residual()
/// where it is covered, `uncovered` elsewhere. SIMD, as compare(). Distances in metres.
void write_residuals(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                     const PixelPrices& prices, const PixelPlane<float>& uncovered,
                     std::span<float> residuals);

}  // namespace hypotrack::rgbd_depth
