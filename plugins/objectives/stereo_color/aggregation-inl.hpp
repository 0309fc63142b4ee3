#pragma once

#include <cmath>

#include "hypotrack/plugin/pixel.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// Returns the score of one direction. `sum` is over the similarities of pixels seen in both views,
/// `seen` is their number, `rendered` is the number of pixels rendered. Returns 0 without any
/// pixel.
HYPOTRACK_PIXEL double aggregate(Aggregation aggregation, double sum, double seen,
                                 double rendered) {
  double n = 1.0;
  if (aggregation == Aggregation::mean_seen) n = seen;
  if (aggregation == Aggregation::mean_rendered) n = rendered;
  if (aggregation == Aggregation::sum_per_sqrt) n = std::sqrt(rendered);
  return n > 0.0 ? sum / n : 0.0;
}

}  // namespace hypotrack::stereo_color
