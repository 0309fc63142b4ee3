#pragma once

#include <cstddef>

#include "hypotrack/pixel.hpp"

namespace hypotrack::skin {

/// Levels per channel; colours are quantised into kLevels^3 bins.
inline constexpr int kLevels = 32;
inline constexpr std::size_t kBins = std::size_t{kLevels} * kLevels * kLevels;

/// Returns the bin of an 8-bit colour.
HYPOTRACK_PIXEL int bin_of(int blue, int green, int red) {
  constexpr int kWidth = 256 / kLevels;
  return (blue / kWidth * kLevels + green / kWidth) * kLevels + red / kWidth;
}

}  // namespace hypotrack::skin
