#pragma once

#include <span>

#include "hypotrack/plugin/pixel.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "params.hpp"
#include "score.hpp"

namespace hypotrack::stereo_color {

/// Writes the residuals of write_residuals() (residuals.hpp) and their slopes d r / d(1/z), for
/// every pixel of `here`, rows without gaps. Slopes are central differences over kSlopeReach
/// in the other view. They use interpolated colours whatever params.lookup is. They are 0 where the
/// pixel is uncovered or occluded. SIMD, as measure().
void write_slopes(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                  const Params& params, float share, const PixelPlane<float>& uncovered,
                  std::span<float> residuals, std::span<float> slopes);

}  // namespace hypotrack::stereo_color
