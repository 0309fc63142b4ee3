#pragma once

#include <cstdint>

#include "hypotrack/view_pixels.hpp"
#include "settings.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// What the filling of a volume reads.
struct VolumeJob {
  StereoMap map;            ///< from the first view into the second
  PixelPlane<float> left;   ///< gray_tile() of the first view, no margin
  PixelPlane<float> right;  ///< of the second view
  int margin;               ///< of `right`
};

/// Fills volume.words, which have the size that planes, width and height ask for, and whose other
/// members are set.
void fill_volume(const VolumeJob& job, const Settings& settings, Volume& volume);

/// The instruction sets that fill_volume() is compiled for, as Highway's bits.
std::int64_t volume_targets();

}  // namespace hypotrack::stereo_patch
