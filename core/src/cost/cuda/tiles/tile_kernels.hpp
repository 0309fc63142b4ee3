#pragma once

#include "base/exported.hpp"
#include "cost/cuda/tiles/tile_pixels.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Everything that the tile kernels of a frame read and write; pointers are to device memory.
struct FrameResampling {
  ViewResampling views[kMaxViews];
  std::int32_t view_count;
  FrameLayout layout;
  FrameLayout* layout_to;  ///< address from which search kernels read the layout
};

/// Enqueues the resampling of all tiles and the copy of the layout. All uploads that the views
/// point to must be enqueued before.
void enqueue_resampling(const FrameResampling& frame, const DeviceLimits& limits, Stream stream);

}  // namespace internal
}  // namespace hypotrack::cuda
