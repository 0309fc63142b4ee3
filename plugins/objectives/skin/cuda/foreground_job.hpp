#pragma once

#include <array>
#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"
#include "rule.hpp"

namespace hypotrack::skin {

/// What is to be done for one view that is looked at; everything is in device memory.
struct ViewJob {
  cuda::TileLayout tile;
  Rule rule;
  DepthRange range;            ///< Rule::depth
  const float* probabilities;  ///< Rule::color: per bin
  std::uint32_t* pixels;       ///< ViewForeground::pixels, row by row without gaps
};

struct ForegroundJob {
  std::array<ViewJob, cuda::kMaxViews> views;
  int view_count;
  unsigned long long* sum;  ///< of the low halves of all views' pixels
};

/// Enqueues the telling of foreground from background: the numbers of ForegroundTeller::tell().
void enqueue_foreground(const ForegroundJob& job, cuda::Stream stream);

}  // namespace hypotrack::skin
