#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/statistics/metric_info.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Values of one cell, one per seed, in the order of the seeds.
struct Sample {
  std::vector<long> seeds;
  std::vector<double> values;  ///< finite
};

/// Statistics of one sample, and its test against the best one.
struct Comparison {
  double mean = 0;  ///< NaN without values
  double sd = 0;    ///< NaN with fewer than two
  std::size_t count = 0;
  bool best = false;
  /// Probability of a difference from the best sample at least as large by chance alone, corrected
  /// for multiple comparisons. Nothing for the best, and where there is nothing to test.
  std::optional<double> p;
  /// Seeds that would separate it from the best, by power.hpp; only of samples that are not.
  std::optional<int> seeds_needed;
};

inline constexpr double kSignificant = 0.05;

/// Finds the best of several samples and tests which differ from it. The test is the signed-rank
/// test if both have the same seeds, otherwise the rank-sum test. Holm's method corrects the p
/// values. There is no best and no test with one sample, or for metrics of which neither end is
/// better.
std::vector<Comparison> compare_samples(const std::vector<Sample>& samples,
                                        MetricInfo::Better better);

/// Returns the p value of the difference of two samples, without correction.
double test_difference(const Sample& a, const Sample& b);

/// Returns the seeds with which that test would give p < alpha for the difference seen.
std::optional<int> seeds_needed(const Sample& a, const Sample& b, double alpha);

}  // namespace internal
}  // namespace hypotrack
