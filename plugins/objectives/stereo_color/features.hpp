#pragma once

#include <cstdint>

#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "params.hpp"

namespace hypotrack::stereo_color {

/// Features of one tile: three colour channels and the weight C of every pixel, all in 0..1 as
/// 16-bit fractions, two in a word.
struct Features {
  PixelPlane<std::uint32_t> channels_01;
  PixelPlane<std::uint32_t> channel_2_weight;
};

/// Computes colours in the parameters' colour space, scaled to 0..1, and weights.
///   rgb   R, G, B; with a gray_weight g below 1 each less (1 - g) ((R + G + B) / 3 - 1/2), clamped
///         to 0..1, which the most saturated colours exceed by (1 - g) / 6
///   lab   CIE L / 100, (a + 128) / 255, (b + 128) / 255
///   hsv   on the cone, so that hues near 0 and 360 degrees are near each other and black has none:
///         (1 + S V cos H) / 2, (1 + S V sin H) / 2, V
///   gray  0.299 R + 0.587 G + 0.114 B, 0, 0
/// The weight is the distinctiveness (or 1). It is 0 where the pixel is invalid or, with use_mask,
/// background.
Features make_features(const TileView& view, const Params& params);

}  // namespace hypotrack::stereo_color
