#pragma once

#include <cstdint>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// A frame's volume in device memory, which does not move until a larger one comes.
class DeviceVolume {
 public:
  explicit DeviceVolume(const Settings& settings) : settings_(settings) {}

  /// Enqueues the filling for a frame. Throws DataError as StereoPatch::prepare() does.
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Returns device memory: Volume::words. planes() returns their planes, also in device memory.
  const std::uint32_t* words() const { return words_.data(); }
  const Planes* planes() const { return planes_.data(); }

 private:
  Settings settings_;
  cuda::DeviceBuffer<std::uint32_t> words_;
  cuda::DeviceBuffer<Planes> planes_;
};

}  // namespace hypotrack::stereo_patch
