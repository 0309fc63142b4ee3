#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hypotrack {

/// Returns the median of at least one value; of an even number the upper of the middle two.
template <class T>
T upper_median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Quantises a setting that follows recent frames to the nearest power of 1.1; `value` > 0. A
/// quantised setting rarely changes. So costs of successive frames stay comparable, and CUDA graphs
/// of a search are rarely recaptured.
inline double quantize_log(double value) {
  constexpr double kStep = 1.1;
  return std::pow(kStep, std::round(std::log(value) / std::log(kStep)));
}

/// How the damping of a Levenberg-Marquardt search changes.
struct DampingSchedule {
  double first = 0.1;               ///< of the first step
  double least = 1e-7, most = 1e7;  ///< limits
  double accepted = 1;              ///< factor after a step that lowered the cost
  double rejected = 10;             ///< factor after a step that did not
};

/// The damping of a Levenberg-Marquardt search. It falls after accepted steps, towards
/// Gauss-Newton, and rises after rejected ones, towards short steps downhill.
class Damping {
 public:
  explicit Damping(const DampingSchedule& schedule) : schedule_(schedule), value_(schedule.first) {}

  double value() const { return value_; }
  /// Returns whether the last rejection asked for more than the schedule's `most`.
  bool exhausted() const { return exhausted_; }

  /// Continues after an accepted step of the damping `at`.
  void accept(double at) {
    exhausted_ = false;
    value_ = std::clamp(schedule_.accepted * at, schedule_.least, schedule_.most);
  }
  void accept() { accept(value_); }

  /// Continues after rejected steps, the most damped of them by `at`.
  void reject(double at) {
    const double wanted = schedule_.rejected * at;
    exhausted_ = wanted > schedule_.most;
    value_ = std::min(wanted, schedule_.most);
  }
  void reject() { reject(value_); }

  /// Multiplies the damping, within its limits, after a step that is neither good nor bad.
  void scale(double factor) {
    value_ = std::clamp(factor * value_, schedule_.least, schedule_.most);
  }
  /// Lowers the damping to its first value, for a search that goes on with other derivatives.
  void lower_to_first() { value_ = std::min(value_, schedule_.first); }

 private:
  DampingSchedule schedule_;
  double value_;
  bool exhausted_ = false;
};

/// Adds damping * (entry + floor) to every diagonal entry of normal equations. The floor holds
/// unknowns that hardly change the cost; a share of the mean diagonal is usual.
inline void damp(Eigen::MatrixXd& normal, double damping, double floor) {
  normal.diagonal().array() += damping * (normal.diagonal().array() + floor);
}

/// Returns whether a value is at a bound that a step against its gradient would cross.
inline bool blocked_by_bound(double value, double lower, double upper, double gradient) {
  return (value <= lower && gradient > 0) || (value >= upper && gradient < 0);
}

}  // namespace hypotrack
