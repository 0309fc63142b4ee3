#pragma once

#include <cstdint>
#include <span>

#include "hypotrack/plugin/pixel.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "params.hpp"
#include "score.hpp"

namespace hypotrack::stereo_color {

/// Returns sqrt(share C) of every pixel: the residuals of a hypothesis that covers nothing.
PixelPlane<float> uncovered_residuals(const Features& features, float share);

/// Writes sqrt(share (C - s)) for every pixel of `here`, rows without gaps. s is the summand of
/// measure(), 0 where the pixel is uncovered or occluded. `uncovered` is uncovered_residuals() of
/// the features and the share. The sum of squares is share (sum of C - S). Returns the result of
/// measure(). SIMD, as measure().
Similarity write_residuals(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                           const Params& params, float share, const PixelPlane<float>& uncovered,
                           std::span<float> residuals);

/// Writes the residuals of write_residuals() and their slopes d r / d(1/z), for
/// every pixel of `here`, rows without gaps. Slopes are central differences over kSlopeReach
/// in the other view. They use interpolated colours whatever params.lookup is. They are 0 where the
/// pixel is uncovered or occluded. SIMD, as measure().
void write_slopes(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                  const Params& params, float share, const PixelPlane<float>& uncovered,
                  std::span<float> residuals, std::span<float> slopes);

}  // namespace hypotrack::stereo_color
