#pragma once

#include <cstdint>

#include "hypotrack/plugin/view_pixels.hpp"
#include "settings.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Input of the filling of a volume.
struct VolumeJob {
  StereoMap map;            ///< from the first view to the second
  PixelPlane<float> left;   ///< gray_tile() of the first view, no margin
  PixelPlane<float> right;  ///< gray_tile() of the second view
  int margin;               ///< of `right`
};

/// Fills volume.words. They must have the size for planes, width and height, and all other members
/// must be set.
void fill_volume(const VolumeJob& job, const Settings& settings, Volume& volume);

/// Returns the instruction sets that fill_volume() is compiled for, as Highway's bits.
std::int64_t volume_targets();

}  // namespace hypotrack::stereo_patch
