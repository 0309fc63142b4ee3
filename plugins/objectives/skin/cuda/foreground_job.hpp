#pragma once

#include <array>
#include <cstdint>

#include "color_bins.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "rule.hpp"

namespace hypotrack::skin {

/// The computation for one used view; all pointers are to device memory.
struct ViewJob {
  cuda::TileLayout tile;
  Rule rule;
  DepthRange range;                   ///< Rule::depth
  const float* probabilities;         ///< Rule::color: per bin
  const ColorFrequency* frequencies;  ///< per bin; null without `background`
  const std::uint32_t* background;    ///< TileView::background; null without
  std::uint32_t* pixels;              ///< ViewForeground::pixels, row by row without gaps
};

struct ForegroundJob {
  std::array<ViewJob, cuda::kMaxViews> views;
  int view_count;
  unsigned long long* sum;  ///< of the low halves of all views' pixels
};

/// Enqueues the separation of foreground and background, with the results of
/// ForegroundEstimator::estimate().
void enqueue_foreground(const ForegroundJob& job, cuda::Stream stream);

}  // namespace hypotrack::skin
