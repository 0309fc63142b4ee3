#pragma once

#include <cstddef>

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::skin {

/// Levels per channel; colours are quantised into kLevels^3 bins.
inline constexpr int kLevels = 32;
inline constexpr std::size_t kBins = std::size_t{kLevels} * kLevels * kLevels;

/// Returns the bin of an 8-bit colour.
HYPOTRACK_PIXEL int bin_of(int blue, int green, int red) {
  constexpr int kWidth = 256 / kLevels;
  return (blue / kWidth * kLevels + green / kWidth) * kLevels + red / kWidth;
}

/// Frequencies of a colour on the models and beside them.
struct ColorFrequency {
  float foreground = 1;
  float background = 1;
};

/// Returns the probability that a pixel is foreground where its background is known. The pixel
/// shows that background with noise, or rarely something else that has the colours beside the
/// models. `square` is the squared distance between the pixel's and the background's colour (0 ..
/// 255).
HYPOTRACK_PIXEL float foreground_before(ColorFrequency color, float square) {
  constexpr float kNoise = 5;        // standard deviation of a channel
  constexpr float kDensity = 0.26f;  // of that normal distribution at its middle, per bin
  constexpr float kElse = 0.05f;     // share of frames in which something else moved there
  constexpr float kUnseen = 1e-6f;
  const float shows = kDensity * pixel::exp(-square / (2 * kNoise * kNoise));
  const float background = (1 - kElse) * shows + kElse * color.background;
  return color.foreground / (color.foreground + background + kUnseen);
}

}  // namespace hypotrack::skin
