#pragma once

#include <cstdint>

#include "foreground-inl.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/view_pixels.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {

/// What tells foreground in a view with or without a mask.
constexpr Rule rule_of(Foreground foreground, bool has_mask) {
  if (foreground == Foreground::skin) return Rule::skin;
  const bool mask =
      foreground == Foreground::mask || (foreground == Foreground::automatic && has_mask);
  return mask ? Rule::mask : Rule::depth;
}

/// What one view observed.
struct ObservedView {
  PixelPlane<float> pixels;     ///< per pixel what observed.hpp says
  std::int64_t foreground = 0;  ///< number of pixels with o_s: measured or not
  std::int64_t measured = 0;    ///< number of those with a depth
};

/// Tells foreground from background in a view with depth. By
///   mask   what the mask says
///   depth  pixels measured within `range`
///   skin   pixels of the colour of skin, unless measured outside `range`
///   auto   mask if the view has one, otherwise depth
/// The view must have what its way needs. Pixels that are not valid are outside.
ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range);

}  // namespace hypotrack::rgbd_depth
