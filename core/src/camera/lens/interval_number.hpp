#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// An interval of numbers from `low` to `high`. A formula on intervals gives an interval that
/// contains its value for all numbers in them, up to rounding (interval arithmetic, Moore 1966).
struct IntervalNumber {
  double low = 0;
  double high = 0;

  // Implicit, so that formulas can mix intervals and numbers.
  constexpr IntervalNumber(double number) : low(number), high(number) {}
  constexpr IntervalNumber(double from, double to) : low(from), high(to) {}

  /// Returns the smallest interval that contains four numbers.
  static constexpr IntervalNumber around(const std::array<double, 4>& numbers) {
    const auto [low, high] = std::ranges::minmax(numbers);
    return {low, high};
  }
  /// Returns an unknown interval (NaN); every formula on it is unknown.
  static constexpr IntervalNumber unknown() {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
};

constexpr IntervalNumber operator+(IntervalNumber a, IntervalNumber b) {
  return {a.low + b.low, a.high + b.high};
}

constexpr IntervalNumber operator*(IntervalNumber a, IntervalNumber b) {
  return IntervalNumber::around({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

/// Divides two intervals. Unknown if the divisor reaches below 0.01, where rounding would matter.
constexpr IntervalNumber operator/(IntervalNumber a, IntervalNumber b) {
  constexpr double kNearZero = 0.01;
  if (!(b.low > kNearZero)) return IntervalNumber::unknown();
  return a * IntervalNumber(1 / b.high, 1 / b.low);
}

}  // namespace internal
}  // namespace hypotrack
