#pragma once

#include <array>

#include "hypotrack/cuda/runtime.cuh"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {

/// Takes tiles that the CPU cut to the device.
class TileUpload {
 public:
  /// Enqueues the copies. What an earlier call enqueued must have been waited for.
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

}  // namespace hypotrack::cuda
