#pragma once

#include <array>
#include <vector>

#include "cuda/observe_job.hpp"
#include "finger_pair.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {

/// What a frame observed, in device memory that stays where it is until a larger frame comes.
class DeviceFrame {
 public:
  explicit DeviceFrame(const Settings& settings) : settings_(settings) {}

  /// Enqueues what makes it of a frame that has been checked (checks.hpp).
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Device memory: per pixel what observed.hpp says; null for a view without depth.
  const float* observed(int view) const { return views_[static_cast<std::size_t>(view)]; }
  /// Device memory: of all views together.
  const Counts* counts() const { return counts_.data(); }
  /// Device memory: the scene's neighbouring fingers.
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
