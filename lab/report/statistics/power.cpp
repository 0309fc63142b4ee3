#include "lab/report/statistics/power.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/statistics.hpp"
#include "lab/report/statistics/significance.hpp"

namespace hypotrack::internal {
namespace {

double upper_quantile(double probability) {
  return boost::math::quantile(complement(boost::math::normal(), probability));
}

/// Returns the seeds that two-sided tests of ranks need. `effect` is the difference over the
/// standard deviation; `samples` is 1 for pairs, 2 for independent samples.
int seeds_for(double effect, double alpha, int samples, int fewest) {
  const double quantile = upper_quantile(alpha / 2);
  const double of_normal = std::pow((quantile + upper_quantile(1 - kPower)) / effect, 2);
  const double of_t = samples * of_normal + quantile * quantile / (2 * samples);
  const double seeds = std::ceil(of_t * std::numbers::pi / 3);
  return static_cast<int>(std::clamp<double>(seeds, fewest, kMostSeeds + 1));
}

}  // namespace

int fewest_pairs(double alpha) {
  int pairs = 1;
  while (pairs <= kMostSeeds && smallest_signed_rank_p(pairs) >= alpha) ++pairs;
  return pairs;
}

std::optional<int> pairs_needed(std::span<const double> a, std::span<const double> b,
                                double alpha) {
  if (a.size() != b.size()) throw std::invalid_argument("pairs need samples of equal length");
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  const double deviation = sample_deviation(differences);
  const double difference = std::abs(mean(differences));
  if (std::isnan(deviation) || difference == 0) return std::nullopt;
  return seeds_for(difference / deviation, alpha, 1, fewest_pairs(alpha));
}

std::optional<int> values_needed(std::span<const double> a, std::span<const double> b,
                                 double alpha) {
  const double deviation = std::hypot(sample_deviation(a), sample_deviation(b)) / std::sqrt(2.0);
  const double difference = std::abs(mean(a) - mean(b));
  if (std::isnan(deviation) || difference == 0) return std::nullopt;
  int fewest = 1;
  while (fewest <= kMostSeeds && smallest_rank_sum_p(fewest, fewest) >= alpha) ++fewest;
  return seeds_for(difference / deviation, alpha, 2, fewest);
}

}  // namespace hypotrack::internal
