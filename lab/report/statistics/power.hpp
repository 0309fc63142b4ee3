#pragma once

#include <optional>
#include <span>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// How many seeds a test needs to find, with a probability (power) of 80 %, a difference as large
// as that seen. A t test's number (Guenther, The American Statistician 35, 1981) is divided by the
// efficiency of ranks for normal values, 3/pi (Hodges and Lehmann, Annals of Mathematical
// Statistics 27, 1956). It is never below what the exact test can separate at all.

inline constexpr double kPower = 0.8;
/// The largest number of seeds that is told; one more stands for all above.
inline constexpr int kMostSeeds = 1000;

/// Returns the pairs that signed_rank_test() needs for p < alpha. Nothing if the differences of
/// a[i] and b[i] have the mean 0, or are fewer than two. Throws std::invalid_argument on different
/// lengths.
std::optional<int> pairs_needed(std::span<const double> a, std::span<const double> b, double alpha);

/// Returns the values of each sample that rank_sum_test() needs for p < alpha. Nothing if the means
/// are equal, or if a sample has fewer than two values.
std::optional<int> values_needed(std::span<const double> a, std::span<const double> b,
                                 double alpha);

/// Returns the fewest pairs for which signed_rank_test() can give p < alpha.
int fewest_pairs(double alpha);

}  // namespace internal
}  // namespace hypotrack
