#pragma once

#include "hypotrack/plugin/pixel.hpp"

/// Foreground of one pixel, for the CPU and for CUDA.
namespace hypotrack::rgbd_depth {

/// Special values of an observation, which otherwise is z of the foreground in metres. Their
/// distance from any depth exceeds all thresholds on depth differences.
inline constexpr float kUnmeasured = -1e6f;  ///< foreground without a depth
inline constexpr float kBackground = -2e6f;  ///< not foreground, whatever its depth
inline constexpr float kOutside = -3e6f;     ///< outside the image

/// Rule that decides foreground in one view.
enum class Rule { mask, depth, skin };

/// Depths z along a camera's axis, metres.
struct DepthRange {
  float nearest = 0;
  float farthest = 0;
};

/// Returns whether a colour is skin by its chrominance: 133 <= Cr <= 173 and 77 <= Cb <= 127 of
/// 8-bit YCrCb (D. Chai, K. N. Ngan, "Face segmentation using skin-color map in videophone
/// applications", IEEE Trans. Circuits and Systems for Video Technology 9(4), 1999). YCrCb is that
/// of ITU-R BT.601 in 14-bit fixed point, with the numbers of OpenCV's cvtColor.
HYPOTRACK_PIXEL bool is_skin(int blue, int green, int red) {
  constexpr int kBits = 14, kHalf = 1 << (kBits - 1), kMiddle = 128 << kBits;
  const int y = (1868 * blue + 9617 * green + 4899 * red + kHalf) >> kBits;
  const int cr = (11682 * (red - y) + kMiddle + kHalf) >> kBits;
  const int cb = (9241 * (blue - y) + kMiddle + kHalf) >> kBits;
  return 133 <= cr && cr <= 173 && 77 <= cb && cb <= 127;
}

/// A pixel of one view.
struct ViewedPixel {
  bool valid;
  bool masked;
  float depth;  ///< metres; 0, negative or NaN: not measured
  int blue, green, red;
};

HYPOTRACK_PIXEL bool is_foreground(const ViewedPixel& pixel, Rule rule, const DepthRange& range) {
  const bool measured = pixel.depth > 0.0f;
  const bool within = measured && pixel.depth >= range.nearest && pixel.depth <= range.farthest;
  if (rule == Rule::mask) return pixel.masked;
  if (rule == Rule::depth) return within;
  return (within || !measured) && is_skin(pixel.blue, pixel.green, pixel.red);
}

/// Returns the observation at a pixel as one number (foreground-inl.hpp).
HYPOTRACK_PIXEL float observed_at(const ViewedPixel& pixel, Rule rule, const DepthRange& range) {
  if (!pixel.valid) return kOutside;
  if (!is_foreground(pixel, rule, range)) return kBackground;
  return pixel.depth > 0.0f ? pixel.depth : kUnmeasured;
}

}  // namespace hypotrack::rgbd_depth
