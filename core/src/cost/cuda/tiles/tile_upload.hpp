#pragma once

#include <array>

#include "base/exported.hpp"
#include "cost/cuda/tiles/load_balance.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Uploads tiles that the CPU has resampled.
class TileUpload {
 public:
  /// Enqueues the copies. Those of an earlier call must have been waited for.
  DeviceObservation upload(const Observation& observation, Stream stream);

 private:
  struct View {
    DeviceBuffer<std::uint32_t> pixels;
    DeviceBuffer<float> depth;
    PinnedBuffer<std::uint32_t> pixels_staging;
    PinnedBuffer<float> depth_staging;
  };
  std::array<View, kMaxViews> views_;
  DeviceBuffer<FrameLayout> layout_{1};
  PinnedBuffer<FrameLayout> layout_staging_{1};
};

/// Returns the cameras of an observation in the kernels' form. Throws DeviceError on more than
/// kMaxViews views.
FrameLayout frame_layout(const Observation& observation, const BandEnds& bands = even_bands());

}  // namespace internal
}  // namespace hypotrack::cuda
