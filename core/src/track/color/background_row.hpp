#pragma once

#include <cstdint>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A row of a picture, or a part of it, with what was learned of its pixels.
struct BackgroundRow {
  static constexpr int kOne = 128;             ///< a level of a channel, in units of the means
  static constexpr std::int16_t kKnown = 140;  ///< steadiness above which a mean is known

  std::int16_t* means[3];  ///< blue, green, red
  std::uint8_t* steady;    ///< 0 .. 255: how well the last pictures agreed with the mean
  int columns;
};

/// Learns a row (8-bit BGR) where `models` is 0. SIMD, the same on all instruction sets.
void learn_background(const std::uint8_t* picture, const std::uint8_t* models,
                      const BackgroundRow& row);

/// Writes a row of means (8-bit BGRA), with alpha 255 where they are known.
void write_background(const BackgroundRow& row, std::uint8_t* out);

}  // namespace internal
}  // namespace hypotrack
