#pragma once

#include "cuda/tile_pixels.hpp"
#include "hypotrack/cuda/device_objective.hpp"

namespace hypotrack::cuda {

/// What tiles of a frame are cut from; pointers are to device memory.
struct FrameCut {
  ViewCut views[kMaxViews];
  std::int32_t view_count;
};

/// Enqueues the cutting of all tiles. Everything that the cuts point to was enqueued before.
void enqueue_cut(const FrameCut& frame, const DeviceLimits& limits, Stream stream);

}  // namespace hypotrack::cuda
