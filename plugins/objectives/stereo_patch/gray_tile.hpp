#pragma once

#include "hypotrack/observation.hpp"
#include "hypotrack/view_pixels.hpp"

namespace hypotrack::stereo_patch {

/// Grey in 0..1 of a tile with `margin` columns before and behind each row; NaN where invalid and
/// in the margins, so that every sum over such a pixel is NaN.
PixelPlane<float> gray_tile(const TileView& view, int margin);

}  // namespace hypotrack::stereo_patch
