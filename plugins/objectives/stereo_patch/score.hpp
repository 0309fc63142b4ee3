#pragma once

#include <cstdint>

#include "hypotrack/objective.hpp"
#include "hypotrack/stereo_pixels.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Sum of the similarities of the pixels of `left` that are covered and seen in `right`, too
/// (within `tolerance` metres). SIMD, for the best instruction set that this machine (or
/// hwy::SetSupportedTargetsForTest) offers; they differ by rounding only.
double sum_similarity(const Volume& volume, const DepthTile& left, const DepthTile& right,
                      const StereoMap& map, float tolerance);

/// The instruction sets that sum_similarity() is compiled for, as Highway's bits.
std::int64_t score_targets();

}  // namespace hypotrack::stereo_patch
