#pragma once

namespace hypotrack::stereo_patch {

/// Planes of the sweep: inverse depths first + k step of the reference view, 0 <= k < count. In a
/// rectified pair they are equidistant in disparity.
struct Planes {
  float first = 0;  ///< 1/m
  float step = 0;   ///< 1/m
  int count = 0;    ///< 2 or more
};

}  // namespace hypotrack::stereo_patch
