#pragma once

#include <cstdint>

#include "hypotrack/pixel.hpp"

namespace hypotrack {

/// An 8-bit BGR pixel for CPU and CUDA code.
struct Bgr {
  std::uint8_t b, g, r;
};

/// Returns the ITU-R BT.601 luma of a pixel, 0 to 1.
HYPOTRACK_PIXEL float gray_level(Bgr p) {
  return (0.299f * static_cast<float>(p.r) + 0.587f * static_cast<float>(p.g) +
          0.114f * static_cast<float>(p.b)) /
         255.0f;
}

}  // namespace hypotrack
