#pragma once

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::stereo_color {

/// What a small functor of somebody else's finds on its way over a hypothesis.
struct WalkCounts {
  int seen = 0, occluded = 0, uncovered = 0;
  int overlaps = 0;  ///< lanes that are more than one of these
  double here = 0;   ///< sum of a feature of the reference view over covered pixels
  double there = 0;  ///< sum of a feature of the other view, nearest, over pixels seen
};

WalkCounts walk(const DepthTile& here, const DepthTile& there, const StereoMap& map,
                const PixelBox& region, const PixelPlane<float>& here_feature,
                const PixelPlane<float>& there_feature);

}  // namespace hypotrack::stereo_color
