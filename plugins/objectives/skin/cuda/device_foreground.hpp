#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::skin {

/// Foreground probability of each pixel of a frame, in device memory that does not move until a
/// larger frame comes.
class DeviceForeground {
 public:
  explicit DeviceForeground(const Settings& settings);
  ~DeviceForeground();

  /// Enqueues the computation. Downloads a frame from which colours are learned, which waits for
  /// the stream. Throws DataError as Skin::prepare() does.
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Returns device memory: ViewForeground::pixels; null for an unused view.
  const std::uint32_t* pixels(int view) const { return pixels_[static_cast<std::size_t>(view)]; }
  /// Returns device memory: the sum of the pixels' low halves over all views.
  const unsigned long long* sum() const { return sum_.data(); }

 private:
  struct View;

  Settings settings_;
  std::vector<std::unique_ptr<View>> views_;
  std::array<const std::uint32_t*, cuda::kMaxViews> pixels_{};
  cuda::DeviceBuffer<unsigned long long> sum_;
};

}  // namespace hypotrack::skin
