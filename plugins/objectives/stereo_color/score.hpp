#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "features.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::stereo_color {

/// Sums over the pixels of the reference view that a hypothesis covers.
struct Similarity {
  double sum = 0;             ///< of s over the pixels seen in both views
  std::int64_t seen = 0;      ///< their number
  std::int64_t rendered = 0;  ///< number of covered pixels, seen or occluded
};

/// One view of a prepared frame, and a hypothesis drawn into it.
struct ScoredView {
  const Features& features;
  const DepthTile& tile;
};

/// Sums the similarities over the covered pixels of `here`. Uses the best SIMD instruction set of
/// this machine (or hwy::SetSupportedTargetsForTest). Instruction sets differ by rounding only.
/// Where rounding moves a point across the border of two pixels (1 in 1e4 or fewer), the neighbour
/// is looked up.
Similarity measure(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                   const Params& params);

/// Returns the instruction sets that measure() is compiled for, as Highway's bits.
std::int64_t compiled_targets();

/// What measure() finds at every pixel of `here`; NaN where not both views see the surface.
struct ScoreMaps {
  cv::Mat1f difference;   ///< ||I_l - I_r||
  cv::Mat1f consistency;  ///< s
};

ScoreMaps score_maps(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                     const Params& params);

/// Returns the weight C of every pixel.
cv::Mat1f weight_map(const Features& features);

}  // namespace hypotrack::stereo_color
