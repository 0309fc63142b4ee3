#pragma once

#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::stereo_patch {

/// Converts a tile to grey in 0..1, with `margin` columns before and behind each row. Invalid
/// pixels and margins are NaN, so that every sum over such a pixel is NaN.
PixelPlane<float> gray_tile(const TileView& view, int margin);

}  // namespace hypotrack::stereo_patch
