#pragma once

#include <cstdint>

#include "hypotrack/gpu/device_objective.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// Input and output of the filling of a volume on the device.
struct FillJob {
  cuda::TileLayout left, right;
  StereoMap map;  ///< from the first view to the second
  Planes planes;
  Measure measure;
  std::int32_t radius;
  float sharpness, variance_floor;
  std::int32_t masked;          ///< whether pixels outside the first view's mask have similarity 0
  std::uint16_t* similarities;  ///< device memory: Volume::words as halves
  Planes* known_planes;         ///< device memory: a copy of `planes` for lookups
};

/// Enqueues the filling, with the results of fill_volume() up to rounding.
void enqueue_fill(const FillJob& job, cuda::Stream stream);

}  // namespace hypotrack::stereo_patch
