#pragma once

#include <algorithm>
#include <array>
#include <limits>

namespace hypotrack {

/// All numbers from `low` to `high`. A formula on intervals yields one that holds whatever the
/// formula yields for numbers taken from them (Moore, 1966), up to the rounding of doubles.
struct Interval {
  double low = 0;
  double high = 0;

  // Implicit, so that formulas mix intervals and numbers.
  constexpr Interval(double number) : low(number), high(number) {}
  constexpr Interval(double from, double to) : low(from), high(to) {}

  /// The smallest one around four numbers.
  static constexpr Interval around(const std::array<double, 4>& numbers) {
    const auto [low, high] = std::ranges::minmax(numbers);
    return {low, high};
  }
  /// What nothing is known about, and no formula on it: NaN.
  static constexpr Interval unknown() {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
};

constexpr Interval operator+(Interval a, Interval b) { return {a.low + b.low, a.high + b.high}; }

constexpr Interval operator*(Interval a, Interval b) {
  return Interval::around({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

/// Unknown where the divisor comes near zero, where rounding would count, or lies below.
constexpr Interval operator/(Interval a, Interval b) {
  constexpr double kNearZero = 0.01;
  if (!(b.low > kNearZero)) return Interval::unknown();
  return a * Interval(1 / b.high, 1 / b.low);
}

}  // namespace hypotrack
