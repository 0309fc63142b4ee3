#pragma once

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::rgbd_depth {

/// Sums over the pixels of all views with depth.
struct Totals {
  double foreground;  ///< number of pixels with o_s: measured or not
  double measured;    ///< number of those with a depth
  double closeness;   ///< of d_M - min(|o_d - r_d|, d_M) where foreground was measured, metres
  double matched;     ///< number with o_s and r_m
  double beyond;      ///< number with r_m but not o_s
};

struct Weights {
  double d_max;  ///< m
  double lambda;
  double lambda_k;
};

inline constexpr double kCentimetresPerMetre = 100;  // unit of depth in the papers, and so of
                                                     // lambda

/// Computes E of RgbdDepth.
HYPOTRACK_PIXEL double energy(const Totals& t, double crossing, const Weights& weights) {
  constexpr double kEpsilon = 1e-6;
  // Every pixel that may differ costs d_M; closeness is subtracted where depths agree.
  const double charged = t.measured + t.beyond;
  const double difference = kCentimetresPerMetre * (weights.d_max * charged - t.closeness);
  const double covered_or_foreground = t.foreground + t.beyond;
  const double both = t.matched + covered_or_foreground;
  const double silhouette = both > 0 ? 1 - 2 * t.matched / both : 1;
  return difference / (covered_or_foreground + kEpsilon) + weights.lambda * silhouette +
         weights.lambda_k * crossing;
}

}  // namespace hypotrack::rgbd_depth
