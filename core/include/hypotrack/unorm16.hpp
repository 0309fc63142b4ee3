#pragma once

#include <cstdint>

#include "hypotrack/pixel.hpp"

namespace hypotrack {

/// Packs two numbers, clamped to 0 .. 1, as 16-bit fractions into one word. unorm16_low() and
/// unorm16_high() (simd-inl.hpp) unpack them. Exact for 8-bit values (k / 255).
HYPOTRACK_PIXEL std::uint32_t pack_unorm16(float low, float high) {
  const auto bits = [](float x) {
    return static_cast<std::uint32_t>(pixel::min(pixel::max(x, 0.0f), 1.0f) * 65535.0f + 0.5f);
  };
  return bits(low) | bits(high) << 16;
}

}  // namespace hypotrack
