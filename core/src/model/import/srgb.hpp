#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

// sRGB's transfer function (IEC 61966-2-1). Pictures have 8-bit sRGB; glTF has its factors and
// vertex colours linear in light; colours of all other formats are what a screen shows.
namespace hypotrack::srgb {

/// Decodes a share of sRGB's range into a share of light.
inline float linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Encodes a share of light as a share of sRGB's range.
inline float encoded(float light) {
  return light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
}

/// Returns a share of the range as a byte. What is no number becomes 0.
inline std::uint8_t byte(float share) {
  return share > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(share, 1.0f))) : 0;
}

/// Returns the light of every byte.
inline const std::array<float, 256>& light_of_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = linear(static_cast<float>(i) / 255);
    return all;
  }();
  return table;
}

/// Encodes a share of light from 0 to 1 as a byte, by a table.
inline std::uint8_t byte_of_light(float light) {
  constexpr std::size_t kSteps = 1 << 13;  // a third of a byte's step where it is dark
  static const std::array<std::uint8_t, kSteps + 1> table = [] {
    std::array<std::uint8_t, kSteps + 1> all{};
    for (std::size_t i = 0; i <= kSteps; ++i)
      all[i] = byte(encoded(static_cast<float>(i) / static_cast<float>(kSteps)));
    return all;
  }();
  return table[static_cast<std::size_t>(
      std::lround(std::clamp(light, 0.0f, 1.0f) * static_cast<float>(kSteps)))];
}

}  // namespace hypotrack::srgb
