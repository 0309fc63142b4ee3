#pragma once

#include <cstdint>

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

}  // namespace hypotrack::stereo_color
