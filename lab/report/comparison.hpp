#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/report/metric_info.hpp"

namespace hypotrack {

/// What the runs of one cell measured: a value per seed, in the order of the seeds.
struct Sample {
  std::vector<long> seeds;
  std::vector<double> values;  ///< finite
};

/// One sample among those it is compared with.
struct Comparison {
  double mean = 0;  ///< NaN without values
  double sd = 0;    ///< NaN with fewer than two
  std::size_t count = 0;
  bool best = false;
  /// Probability of a difference from the best one at least as large by chance alone, corrected for
  /// the number of comparisons; nothing for the best and where there is nothing to test.
  std::optional<double> p;
};

inline constexpr double kSignificant = 0.05;

/// Which of several samples is best, and which differ from it: for each a signed-rank test over the
/// seeds that both have if they are the same, otherwise a rank-sum test; corrected by Holm's
/// method. No best and no test for metrics of which neither end is better or with one sample only.
HYPOTRACK_API std::vector<Comparison> compare_samples(const std::vector<Sample>& samples,
                                                      MetricInfo::Better better);

/// The comparison of one sample with another before any correction.
HYPOTRACK_API double test_difference(const Sample& a, const Sample& b);

}  // namespace hypotrack
