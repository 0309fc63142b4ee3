#pragma once

#include "cost/cuda/tile_pixels.hpp"
#include "hypotrack/cuda/device_objective.hpp"

namespace hypotrack::cuda {

/// What tiles of a frame are cut from, and what else goes up with it; pointers are to device
/// memory.
struct FrameCut {
  ViewCut views[kMaxViews];
  std::int32_t view_count;
  FrameLayout layout;
  FrameLayout* layout_to;  ///< where the kernels of a search look for it
};

/// Enqueues the cutting of all tiles, and the layout. Everything that the cuts point to was
/// enqueued before.
void enqueue_cut(const FrameCut& frame, const DeviceLimits& limits, Stream stream);

}  // namespace hypotrack::cuda
