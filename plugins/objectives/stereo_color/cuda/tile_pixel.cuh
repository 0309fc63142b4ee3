#pragma once

#include <cstdint>

#include "color-inl.hpp"

namespace hypotrack::stereo_color {

/// Returns the colour of a pixel of a cuda::TileLayout.
__device__ __forceinline__ Bgr to_bgr(std::uint32_t pixel) {
  return {static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 8),
          static_cast<std::uint8_t>(pixel >> 16)};
}

}  // namespace hypotrack::stereo_color
