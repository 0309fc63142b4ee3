#pragma once

#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"
#include "planes_layout.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

/// What the filling of a volume on the device reads and writes.
struct FillJob {
  cuda::TileLayout left, right;
  StereoMap map;  ///< from the first view into the second
  Planes planes;
  Measure measure;
  std::int32_t radius;
  float sharpness, variance_floor;
  std::int32_t masked;          ///< whether pixels outside the first view's mask have similarity 0
  std::uint16_t* similarities;  ///< device memory: Volume::words as halves
  Planes* known_planes;         ///< device memory: `planes` once more, for those who look up
};

/// Enqueues the filling: the numbers of fill_volume() up to rounding.
void enqueue_fill(const FillJob& job, cuda::Stream stream);

}  // namespace hypotrack::stereo_patch
