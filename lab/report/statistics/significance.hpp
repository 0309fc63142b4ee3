#pragma once

#include <span>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Computes the two-sided p value of Wilcoxon's signed-rank test (Biometrics Bulletin 1, 1945) for
/// pairs a[i], b[i]. Pairs without a difference are left out; equal differences share their mean
/// rank. Exact up to 40 pairs, then by the normal approximation with continuity correction. Returns
/// 1 if nothing differs. Throws std::invalid_argument on different lengths.
double signed_rank_test(std::span<const double> a, std::span<const double> b);

/// Computes the two-sided p value of the rank-sum test of Mann and Whitney (Annals of Mathematical
/// Statistics 18, 1947) for two independent samples. Ties share their mean rank. Exact up to 40
/// values in total, then by the normal approximation with tie and continuity correction. Returns 1
/// if a sample is empty.
double rank_sum_test(std::span<const double> a, std::span<const double> b);

/// Corrects p values for their number by Holm's step-down method (Scandinavian Journal of
/// Statistics 6, 1979). Keeps their order.
std::vector<double> holm(std::span<const double> p_values);

/// Returns the smallest p value that signed_rank_test() can give for `pairs` pairs, or
/// rank_sum_test() for two samples of the given sizes. Too few seeds can never separate anything.
double smallest_signed_rank_p(int pairs);
double smallest_rank_sum_p(int first, int second);

}  // namespace internal
}  // namespace hypotrack
