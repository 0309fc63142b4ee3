#pragma once

#include <span>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Writes the residuals of write_residuals() (residuals.hpp) and their slopes d r / d(1/z), for
/// every pixel of `left`, rows without gaps. Slopes are central differences over half the distance
/// of two planes to either side. They are 0 where the pixel is uncovered, occluded or between no
/// planes. SIMD, as sum_similarity().
void write_slopes(const Volume& volume, const DepthTile& left, const DepthTile& right,
                  const StereoMap& map, float tolerance, std::span<float> residuals,
                  std::span<float> slopes);

}  // namespace hypotrack::stereo_patch
