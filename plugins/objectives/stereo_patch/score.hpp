#pragma once

#include <cstdint>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Sums the similarities of the pixels of `left` that are covered and also seen in `right` (within
/// `tolerance` metres). Uses the best SIMD instruction set of this machine (or
/// hwy::SetSupportedTargetsForTest); they differ by rounding only.
double sum_similarity(const Volume& volume, const DepthTile& left, const DepthTile& right,
                      const StereoMap& map, float tolerance);

/// Returns the instruction sets that sum_similarity() is compiled for, as Highway's bits.
std::int64_t score_targets();

}  // namespace hypotrack::stereo_patch
