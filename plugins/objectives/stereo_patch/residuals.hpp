#pragma once

#include <span>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Writes sqrt(weight - s) for every pixel of `left`, rows without gaps. s is the summand of
/// sum_similarity(), 0 where the pixel is uncovered, occluded or between no planes. The sum of
/// squares is that of the weights minus sum_similarity(), which is returned. SIMD, as
/// sum_similarity().
double write_residuals(const Volume& volume, const DepthTile& left, const DepthTile& right,
                       const StereoMap& map, float tolerance, std::span<float> residuals);

}  // namespace hypotrack::stereo_patch
