#pragma once

#include <array>
#include <cstdint>

#include "foreground-inl.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::rgbd_depth {

/// Pixel counts over all views with depth, in device memory.
struct Counts {
  std::uint32_t foreground;  ///< with o_s, measured or not
  std::uint32_t measured;    ///< with o_s and a depth
};

/// The computation for one view with depth.
struct ViewJob {
  cuda::TileLayout tile;
  Rule rule;
  DepthRange range;
  float* observed;  ///< device memory: foreground-inl.hpp, row by row without gaps
};

struct ObserveJob {
  std::array<ViewJob, cuda::kMaxViews> views;
  int view_count;
  Counts* counts;  ///< of all views together
};

/// Enqueues the separation of foreground and background, with the results of observe().
void enqueue_observe(const ObserveJob& job, cuda::Stream stream);

}  // namespace hypotrack::rgbd_depth
