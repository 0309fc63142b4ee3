#pragma once

#include <algorithm>
#include <cstdint>

#include "hypotrack/random.hpp"

// How a population lies about the start, one number at a time: plain arithmetic that a CUDA kernel
// can include. start_points.hpp makes points of them.

namespace hypotrack {

inline constexpr std::uint32_t kStartStream = 1;
inline constexpr std::uint32_t kGroupStream = 2;

/// Bounds of a dimension of the search region.
struct Interval {
  double lower;
  double upper;
};

/// How far the points of a population may lie from the start.
struct StartSpread {
  double sigma = 0.5;       ///< standard deviation in spreads
  double group_share = 1;   ///< probability of a group to use all of it
  double group_rest = 0.1;  ///< what the other groups use of it

  /// The standard deviation, in spreads, of a group's dimensions in point `number` >= 1. Draws
  /// RandomIndex{group, number, 0, 2}.
  HYPOTRACK_PIXEL double of_group(std::uint64_t seed, std::uint32_t group,
                                  std::uint32_t number) const {
    if (group_share >= 1) return sigma;
    const bool fully = uniform4(seed, {group, number, 0, kGroupStream})[0] < group_share;
    return fully ? sigma : sigma * group_rest;
  }
};

/// A dimension of point `number` >= 1: a normal sample about `start` within the bounds. Draws
/// RandomIndex{dimension, number, 0, 1}.
HYPOTRACK_PIXEL double start_sample(double start, double standard_deviation, const Interval& bounds,
                                    std::uint64_t seed, std::uint32_t dimension,
                                    std::uint32_t number) {
  const double x = start + standard_deviation * normal(seed, {dimension, number, 0, kStartStream});
  return std::clamp(x, bounds.lower, bounds.upper);
}

}  // namespace hypotrack
