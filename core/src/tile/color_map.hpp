#pragma once

#include <cmath>
#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/plugin/pixel.hpp"

/// Maps one camera's colours to another's: plain data and the one function that CPU and CUDA share,
/// without Eigen and OpenCV.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Coefficients of gain * value + offset for blue, green and red; values are 0 .. 255.
struct ColorMap {
  float gain[3] = {1, 1, 1};
  float offset[3] = {0, 0, 0};
};

/// Returns true for the identity map.
HYPOTRACK_PIXEL bool keeps_colors(const ColorMap& map) {
  for (int i = 0; i < 3; ++i) {
    if (map.gain[i] != 1.0f || map.offset[i] != 0.0f) return false;
  }
  return true;
}

/// Returns a channel's mapped value, rounded and clamped to 0 .. 255.
HYPOTRACK_PIXEL std::uint32_t mapped_channel(const ColorMap& map, int channel,
                                             std::uint32_t value) {
  const float exact = std::fma(map.gain[channel], static_cast<float>(value), map.offset[channel]);
  return static_cast<std::uint32_t>(pixel::round(pixel::min(pixel::max(exact, 0.0f), 255.0f)));
}

}  // namespace internal
}  // namespace hypotrack
