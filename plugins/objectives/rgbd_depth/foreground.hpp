#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "foreground-inl.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {

/// Returns the range of the posed scene's depths in a camera, widened by `margin` metres at both
/// ends.
DepthRange depth_range(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera,
                       double margin);

/// Returns the rule for a view with or without a mask.
constexpr Rule rule_of(Foreground foreground, bool has_mask) {
  if (foreground == Foreground::skin) return Rule::skin;
  const bool mask =
      foreground == Foreground::mask || (foreground == Foreground::automatic && has_mask);
  return mask ? Rule::mask : Rule::depth;
}

/// Observation of one view.
struct ObservedView {
  PixelPlane<float> pixels;     ///< foreground-inl.hpp per pixel
  std::int64_t foreground = 0;  ///< number of pixels with o_s, measured or not
  std::int64_t measured = 0;    ///< number of those with a depth
};

/// Separates foreground from background in a view with depth, by
///   mask   the mask
///   depth  pixels measured within `range`
///   skin   pixels of skin colour, unless measured outside `range`
///   auto   the mask if the view has one, otherwise depth
/// The view must have the images that the rule needs. Invalid pixels are outside.
ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range);

}  // namespace hypotrack::rgbd_depth
