#pragma once

#include <cstdint>
#include <span>

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

/// Writes sqrt(weight - s) for every pixel of `left`, rows without gaps. s is the summand of
/// sum_similarity(), 0 where the pixel is uncovered, occluded or between no planes. The sum of
/// squares is that of the weights minus sum_similarity(), which is returned. SIMD, as
/// sum_similarity().
double write_residuals(const Volume& volume, const DepthTile& left, const DepthTile& right,
                       const StereoMap& map, float tolerance, std::span<float> residuals);

/// Writes the residuals of write_residuals() and their slopes d r / d(1/z), for
/// every pixel of `left`, rows without gaps. Slopes are central differences over half the distance
/// of two planes to either side. They are 0 where the pixel is uncovered, occluded or between no
/// planes. SIMD, as sum_similarity().
void write_slopes(const Volume& volume, const DepthTile& left, const DepthTile& right,
                  const StereoMap& map, float tolerance, std::span<float> residuals,
                  std::span<float> slopes);

}  // namespace hypotrack::stereo_patch
