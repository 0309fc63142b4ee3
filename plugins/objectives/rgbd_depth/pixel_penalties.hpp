#pragma once

#include "energy.hpp"
#include "foreground-inl.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::rgbd_depth {

/// Cost of a pixel near the observation. With F observed foreground pixels, one that disagrees adds
/// about d_M / F to D and 1 / (2 F) to S.
struct PixelPenalties {
  float wrong = 0;   ///< covered by mistake, missed or d_M off: 100 d_M / F + lambda / (2 F)
  float hidden = 0;  ///< missed where the sensor had a hole: lambda / (2 F)
};

HYPOTRACK_PIXEL PixelPenalties pixel_penalties(float foreground, const Weights& weights) {
  const float share = 1.0f / pixel::max(foreground, 1.0f);
  const float hidden = 0.5f * static_cast<float>(weights.lambda) * share;
  return {static_cast<float>(kCentimetresPerMetre * weights.d_max) * share + hidden, hidden};
}

/// Returns the residual of an uncovered pixel: sqrt(wrong) where foreground was measured,
/// sqrt(hidden) where it was not, 0 elsewhere.
HYPOTRACK_PIXEL float uncovered_residual(float observed, const PixelPenalties& penalties) {
  if (observed > 0) return pixel::sqrt(penalties.wrong);
  return observed == kUnmeasured ? pixel::sqrt(penalties.hidden) : 0.0f;
}

/// Returns the residual of a pair of fingers that cross by `crossing` radians. Its square equals
/// the term of E at 0.1 radians.
HYPOTRACK_PIXEL float crossing_residual(double crossing, const Weights& weights) {
  constexpr double kEqualAt = 0.1;
  return pixel::sqrt(static_cast<float>(weights.lambda_k / kEqualAt)) *
         static_cast<float>(crossing);
}

}  // namespace hypotrack::rgbd_depth
