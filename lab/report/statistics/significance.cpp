#include "lab/report/statistics/significance.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/binomial.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kLargestExact = 40;

/// Returns the rank of each value from 1, doubled so that mean ranks of ties are integers.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::size_t> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) ++last;
    for (std::size_t i = first; i <= last; ++i) ranks[order[i]] = first + last + 2;
    first = last + 1;
  }
  return ranks;
}

/// Returns the two-sided p of an observed sum. `counts` says how many of the equally likely
/// outcomes have each sum.
double two_sided(const std::vector<double>& counts, std::size_t observed) {
  const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
  const auto split = counts.begin() + static_cast<std::ptrdiff_t>(observed);
  const double lower = std::accumulate(counts.begin(), split + 1, 0.0);
  const double upper = std::accumulate(split, counts.end(), 0.0);
  return std::min(1.0, 2 * std::min(lower, upper) / total);
}

double normal_two_sided(double distance, double variance) {
  if (!(variance > 0)) return 1;
  const double z = std::max(0.0, std::abs(distance) - 0.5) / std::sqrt(variance);
  return std::min(1.0, 2 * boost::math::cdf(complement(boost::math::normal(), z)));
}

/// Counts, over all choices of signs, how often the positive ranks have each sum.
std::vector<double> sign_counts(const std::vector<std::size_t>& ranks) {
  std::vector<double> counts{1};
  for (const std::size_t rank : ranks) {
    std::vector<double> next(counts.size() + rank);
    for (std::size_t sum = 0; sum < counts.size(); ++sum) {
      next[sum] += counts[sum];
      next[sum + rank] += counts[sum];
    }
    counts = std::move(next);
  }
  return counts;
}

/// Counts, over all choices of `chosen` of the ranks, how often they have each sum.
std::vector<double> subset_counts(const std::vector<std::size_t>& ranks, std::size_t chosen) {
  const std::size_t most = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::vector<std::vector<double>> counts(chosen + 1, std::vector<double>(most + 1));
  counts[0][0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t k = chosen; k-- > 0;)
      for (std::size_t sum = 0; sum + rank <= most; ++sum)
        counts[k + 1][sum + rank] += counts[k][sum];
  return counts[chosen];
}

}  // namespace

double signed_rank_test(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw std::invalid_argument("pairs need samples of equal length");
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    sizes.push_back(std::abs(a[i] - b[i]));
    positive.push_back(a[i] > b[i]);
  }
  if (sizes.empty()) return 1;
  const std::vector<std::size_t> ranks = doubled_ranks(sizes);
  std::size_t sum = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) sum += positive[i] ? ranks[i] : 0;
  if (sizes.size() <= kLargestExact) return two_sided(sign_counts(ranks), sum);
  double all = 0, squares = 0;
  for (const std::size_t rank : ranks) {
    all += static_cast<double>(rank) / 2;
    squares += static_cast<double>(rank * rank) / 4;
  }
  return normal_two_sided(static_cast<double>(sum) / 2 - all / 2, squares / 4);
}

double rank_sum_test(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) return 1;
  std::vector<double> values(a.begin(), a.end());
  values.insert(values.end(), b.begin(), b.end());
  const std::vector<std::size_t> ranks = doubled_ranks(values);
  const std::size_t sum = std::accumulate(
      ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), std::size_t{0});
  if (values.size() <= kLargestExact) return two_sided(subset_counts(ranks, a.size()), sum);
  // The variance of a sum drawn without replacement accounts for ties by itself.
  const auto n = static_cast<double>(values.size());
  const double center = (n + 1) / 2;
  double squares = 0;
  for (const std::size_t rank : ranks)
    squares += std::pow(static_cast<double>(rank) / 2 - center, 2);
  const auto na = static_cast<double>(a.size());
  const auto nb = static_cast<double>(b.size());
  return normal_two_sided(static_cast<double>(sum) / 2 - na * center,
                          na * nb / (n * (n - 1)) * squares);
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> corrected(p_values.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(order.size() - i) * p_values[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

double smallest_signed_rank_p(int pairs) { return std::min(1.0, std::ldexp(2.0, -pairs)); }

double smallest_rank_sum_p(int first, int second) {
  if (first <= 0 || second <= 0) return 1;
  return std::min(
      1.0, 2 / boost::math::binomial_coefficient<double>(static_cast<unsigned>(first + second),
                                                         static_cast<unsigned>(first)));
}

}  // namespace hypotrack::internal
