#pragma once

#include "random_pair.hpp"

namespace hypotrack::stereo_patch {

using stereo_color::PairOptions;

/// stereo_color's made-up pair around a box of 60 x 40 x 20 mm at 0.5 m, which says where depths
/// are compared. `smooth`: with texture of several pixels' width that both views share.
struct PatchPair : stereo_color::RandomPair {
  explicit PatchPair(const PairOptions& options, bool smooth = false);
};

/// Every colour of a view times `gain` plus `offset`.
void change_brightness(TileView& view, double gain, double offset);

}  // namespace hypotrack::stereo_patch
