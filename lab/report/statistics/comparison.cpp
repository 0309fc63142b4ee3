#include "lab/report/statistics/comparison.hpp"

#include <algorithm>

#include "base/statistics.hpp"
#include "lab/report/statistics/power.hpp"
#include "lab/report/statistics/significance.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the index of the best mean, -1 if there is nothing to choose from.
int best_of(const std::vector<Comparison>& all, MetricInfo::Better better) {
  int best = -1;
  int candidates = 0;
  if (better == MetricInfo::Better::neither) return -1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].count == 0) continue;
    ++candidates;
    const bool first = best < 0;
    const double so_far = first ? 0 : all[static_cast<std::size_t>(best)].mean;
    const bool ahead =
        better == MetricInfo::Better::lower ? all[i].mean < so_far : all[i].mean > so_far;
    if (first || ahead) best = static_cast<int>(i);
  }
  return candidates > 1 ? best : -1;
}

}  // namespace

double test_difference(const Sample& a, const Sample& b) {
  return a.seeds == b.seeds ? signed_rank_test(a.values, b.values)
                            : rank_sum_test(a.values, b.values);
}

std::optional<int> seeds_needed(const Sample& a, const Sample& b, double alpha) {
  return a.seeds == b.seeds ? pairs_needed(a.values, b.values, alpha)
                            : values_needed(a.values, b.values, alpha);
}

std::vector<Comparison> compare_samples(const std::vector<Sample>& samples,
                                        MetricInfo::Better better) {
  std::vector<Comparison> all;
  for (const Sample& sample : samples)
    all.push_back({.mean = mean(sample.values),
                   .sd = sample_deviation(sample.values),
                   .count = sample.values.size(),
                   .best = false,
                   .p = std::nullopt,
                   .seeds_needed = std::nullopt});
  const int best = best_of(all, better);
  if (best < 0) return all;
  const auto best_index = static_cast<std::size_t>(best);
  all[best_index].best = true;
  std::vector<double> p_values;
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == best_index || all[i].count == 0) continue;
    p_values.push_back(test_difference(samples[i], samples[best_index]));
    tested.push_back(i);
  }
  const std::vector<double> corrected = holm(p_values);
  const double alpha = kSignificant / static_cast<double>(std::max<std::size_t>(tested.size(), 1));
  for (std::size_t k = 0; k < tested.size(); ++k) {
    Comparison& comparison = all[tested[k]];
    comparison.p = corrected[k];
    if (corrected[k] >= kSignificant)
      comparison.seeds_needed = seeds_needed(samples[tested[k]], samples[best_index], alpha);
  }
  return all;
}

}  // namespace hypotrack::internal
