#pragma once

#include <array>
#include <span>
#include <vector>

#include "hypotrack/export.hpp"

// Numbers about a set of errors. Errors are non-negative and finite, in any order and any one unit;
// what has no error (NaN) is left out before: without_nan. Of no errors at all everything is NaN.

namespace hypotrack {

HYPOTRACK_API std::vector<double> without_nan(std::span<const double> values);

HYPOTRACK_API double mean(std::span<const double> values);

/// Of the values themselves, not estimated for a larger population: divided by n.
HYPOTRACK_API double standard_deviation(std::span<const double> values);

/// The value that a share 0 <= p <= 1 of the values lies below, linear between the two nearest
/// (Hyndman and Fan's type 7, what NumPy does); p = 0.5 is the median.
HYPOTRACK_API double percentile(std::span<const double> values, double p);

/// Share of the values strictly below a threshold: one point of the success curve.
HYPOTRACK_API double share_below(std::span<const double> values, double threshold);

/// Area under the success curve t -> share_below(values, t) from `low` to `high`, over the width
/// of that interval: 1 if no value exceeds `low`, 0 if none lies below `high`. Exact, without a
/// grid: a value e adds (high - e) / (high - low), cut off at 0 and 1.
HYPOTRACK_API double area_under_success(std::span<const double> values, double low, double high);

inline constexpr int kSuccessCurvePoints = 101;

/// share_below at thresholds 0, 1, 2, ..., 100.
HYPOTRACK_API std::array<double, kSuccessCurvePoints> success_curve(std::span<const double> values);

}  // namespace hypotrack
