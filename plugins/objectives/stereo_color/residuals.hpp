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

}  // namespace hypotrack::stereo_color
