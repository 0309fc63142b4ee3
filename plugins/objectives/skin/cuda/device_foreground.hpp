#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::skin {

/// How likely each pixel of a frame is foreground, in device memory that stays where it is until a
/// larger frame comes.
class DeviceForeground {
 public:
  explicit DeviceForeground(const Settings& settings);
  ~DeviceForeground();

  /// Enqueues what tells it. A frame that colours are learned from is fetched, which waits for the
  /// stream. Throws DataError as Skin::prepare().
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Device memory: ViewForeground::pixels; null for a view that is not looked at.
  const std::uint32_t* pixels(int view) const { return pixels_[static_cast<std::size_t>(view)]; }
  /// Device memory: the sum of their low halves, over all views.
  const unsigned long long* sum() const { return sum_.data(); }

 private:
  struct View;

  Settings settings_;
  std::vector<std::unique_ptr<View>> views_;
  std::array<const std::uint32_t*, cuda::kMaxViews> pixels_{};
  cuda::DeviceBuffer<unsigned long long> sum_;
};

}  // namespace hypotrack::skin
