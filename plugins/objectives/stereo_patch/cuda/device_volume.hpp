#pragma once

#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "planes_layout.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// A frame's volume in device memory that stays where it is until a larger one comes.
class DeviceVolume {
 public:
  explicit DeviceVolume(const Settings& settings) : settings_(settings) {}

  /// Enqueues what fills it. Throws DataError as StereoPatch::prepare().
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Device memory: Volume::words, and the planes they belong to.
  const std::uint32_t* words() const { return words_.data(); }
  const Planes* planes() const { return planes_.data(); }

 private:
  Settings settings_;
  cuda::DeviceBuffer<std::uint32_t> words_;
  cuda::DeviceBuffer<Planes> planes_;
};

}  // namespace hypotrack::stereo_patch
