#pragma once

#include <array>
#include <vector>

#include "cuda/observe_job.hpp"
#include "finger_pair.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {

/// A frame's observed depths in device memory, which does not move until a larger frame comes.
class DeviceFrame {
 public:
  explicit DeviceFrame(const Settings& settings) : settings_(settings) {}

  /// Enqueues the computation for a frame that passed check().
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Returns device memory: foreground-inl.hpp per pixel; null for a view without depth.
  const float* observed(int view) const { return views_[static_cast<std::size_t>(view)]; }
  /// Returns device memory: the counts over all views.
  const Counts* counts() const { return counts_.data(); }
  /// Returns device memory: the scene's adjacent fingers.
  const FingerPair* fingers() const { return fingers_.data(); }
  int finger_count() const { return static_cast<int>(known_fingers_.size()); }

 private:
  void upload_fingers(const Observation& header, cuda::Stream stream);

  Settings settings_;
  std::array<const float*, cuda::kMaxViews> views_{};
  std::array<cuda::DeviceBuffer<float>, cuda::kMaxViews> planes_;
  cuda::DeviceBuffer<Counts> counts_;
  cuda::DeviceBuffer<FingerPair> fingers_;
  std::vector<FingerPair> known_fingers_;
};

}  // namespace hypotrack::rgbd_depth
