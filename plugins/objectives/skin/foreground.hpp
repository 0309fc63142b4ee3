#pragma once

#include <cstdint>

#include "color_learner.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "rule.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

/// Foreground probability of each pixel of one view.
struct ViewForeground {
  /// P (low) and 1 - P (high) as 16-bit fractions; both 0 where the pixel is invalid.
  PixelPlane<std::uint32_t> pixels;
  double sum = 0;  ///< sum of P: the cost of a hypothesis that covers nothing
};

/// Estimates the foreground of one view, frame after frame.
class ForegroundEstimator {
 public:
  explicit ForegroundEstimator(const Settings& settings) : settings_(settings), colors_(settings) {}

  /// Estimates the foreground of the view with that index.
  ViewForeground estimate(const Observation& observation, std::size_t view);

 private:
  Settings settings_;
  ColorLearner colors_;
};

}  // namespace hypotrack::skin
