#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack {

// Counter-based random numbers: pure functions of (seed, index). Threads and GPU blocks draw the
// same numbers in any order. A CUDA kernel can include this file (constexpr functions: compile with
// --expt-relaxed-constexpr).

/// Returns a block of four random 32-bit words for a counter and a key: Philox4x32-10 of Salmon,
/// Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3" (SC 2011).
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {
        static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
        static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key = {key[0] + 0x9E3779B9u, key[1] + 0xBB67AE85u};
  }
  return counter;
}

/// Index of a random number in a population search: the Philox counter, in this order.
struct RandomIndex {
  std::uint32_t dimension = 0;
  std::uint32_t particle = 0;
  std::uint32_t generation = 0;
  std::uint32_t stream = 0;  ///< purpose, if one index needs several blocks
};

/// Returns four independent uniform numbers in the open interval (0, 1): (word + 1/2) / 2^32, exact
/// in double precision. The key is the seed, low word first.
constexpr std::array<double, 4> uniform4(std::uint64_t seed, const RandomIndex& index) {
  const std::array<std::uint32_t, 4> words =
      philox4x32({index.dimension, index.particle, index.generation, index.stream},
                 {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  std::array<double, 4> numbers{};
  for (int i = 0; i < 4; ++i) numbers[i] = (words[i] + 0.5) * 0x1p-32;
  return numbers;
}

/// Returns a standard normal number by the Box-Muller transform of a block's first two uniform
/// numbers; at most 6.8 in magnitude. Another libm (a GPU's) agrees up to the rounding of log and
/// cos.
HYPOTRACK_PIXEL double normal(std::uint64_t seed, const RandomIndex& index) {
  const std::array<double, 4> u = uniform4(seed, index);
  return std::sqrt(-2.0 * std::log(u[0])) * std::cos(2.0 * std::numbers::pi * u[1]);
}

}  // namespace hypotrack

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
