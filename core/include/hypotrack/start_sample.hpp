#pragma once

#include <algorithm>
#include <cstdint>

#include "hypotrack/random.hpp"

// Normal samples of a population about the start, one number at a time. A CUDA kernel can include
// this file. start_points.hpp makes whole points.

namespace hypotrack {

inline constexpr std::uint32_t kStartStream = 1;
inline constexpr std::uint32_t kGroupStream = 2;

/// The bounds of one dimension of the search region.
struct Interval {
  double lower;
  double upper;
};

/// The distribution of a population's first points about the start.
struct StartDistribution {
  double sigma = 0.5;       ///< standard deviation, in units of the region's spread
  double group_share = 1;   ///< probability that a group uses all of sigma
  double group_rest = 0.1;  ///< share of sigma that the other groups use

  /// Returns the standard deviation of a group's dimensions in point `number` >= 1, in units of the
  /// spread. Draws RandomIndex{group, number, 0, 2}.
  HYPOTRACK_PIXEL double of_group(std::uint64_t seed, std::uint32_t group,
                                  std::uint32_t number) const {
    if (group_share >= 1) return sigma;
    const bool fully = uniform4(seed, {group, number, 0, kGroupStream})[0] < group_share;
    return fully ? sigma : sigma * group_rest;
  }
};

/// Returns one dimension of point `number` >= 1: a normal sample about `start`, clamped to the
/// bounds. Draws RandomIndex{dimension, number, 0, 1}.
HYPOTRACK_PIXEL double start_sample(double start, double standard_deviation, const Interval& bounds,
                                    std::uint64_t seed, std::uint32_t dimension,
                                    std::uint32_t number) {
  const double x = start + standard_deviation * normal(seed, {dimension, number, 0, kStartStream});
  return std::clamp(x, bounds.lower, bounds.upper);
}

}  // namespace hypotrack
