#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/exported.hpp"

// Statistics of a set of errors, which are non-negative and finite, in any order and any one unit.
// Remove NaN first with without_nan(). Results for an empty set are NaN.

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

std::vector<double> without_nan(std::span<const double> values);

double mean(std::span<const double> values);

/// Computes the population standard deviation, divided by n.
double standard_deviation(std::span<const double> values);

/// Computes the standard deviation of a sample, divided by n - 1; NaN for fewer than two values.
double sample_deviation(std::span<const double> values);

/// Returns the value below which a share 0 <= p <= 1 of the values lies; p = 0.5 is the median. It
/// interpolates linearly between the two nearest values (Hyndman and Fan's type 7, as NumPy does).
double percentile(std::span<const double> values, double p);

/// Returns the share of values strictly below a threshold: one point of the success curve.
double share_below(std::span<const double> values, double threshold);

/// Computes the area under the success curve t -> share_below(values, t) from `low` to `high`,
/// divided by the width of the interval. It is 1 if no value exceeds `low`, 0 if none lies below
/// `high`. It is exact, without a grid: a value e adds (high - e) / (high - low), clamped to 0 and
/// 1.
double area_under_success(std::span<const double> values, double low, double high);

inline constexpr int kSuccessCurvePoints = 101;

/// Returns share_below() at thresholds 0, 1, 2, ..., 100.
std::array<double, kSuccessCurvePoints> success_curve(std::span<const double> values);

}  // namespace internal
}  // namespace hypotrack
