#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A search for a target: what it spent until it reached the target, or in all if it never did.
struct Trial {
  double spent = 0;
  bool reached = false;
};

/// Returns the expected running time of a search that restarts until it reaches the target: what
/// all trials spent, divided by the number that reached it. Infinite if none did. ERT of COCO
/// (Hansen et al. 2021, doi:10.1080/10556788.2020.1808977).
double expected_running_time(std::span<const Trial> trials);

/// Returns the performance ratios t / min t of a problem, one per solver (Moré and Wild 2009,
/// doi:10.1137/080724083). Infinite for a solver that did not reach the target.
std::vector<double> performance_ratios(std::span<const Trial> of_solvers);

/// Returns what a trial spent in simplex gradients, t / (n + 1) for n dimensions (Moré and Wild
/// 2009). Infinite if it did not reach the target.
double simplex_gradients(const Trial& trial, int dimension);

/// Returns the share of numbers that are at most `limit`; NaN without numbers. Of running times it
/// is their empirical distribution, of ratios the performance profile, of simplex gradients the
/// data profile (Moré and Wild 2009).
double share_within(std::span<const double> numbers, double limit);

/// The median of numbers, and the quartiles around it.
struct Quartiles {
  double lower = 0, median = 0, upper = 0;
};

/// Returns the quartiles, type 7 of Hyndman and Fan (1996); nothing without numbers.
std::optional<Quartiles> quartiles(std::vector<double> numbers);

/// Returns up to `count` places from `lowest` to `highest`, both included, that grow by equal
/// factors. Both are positive.
std::vector<double> geometric_places(double lowest, double highest, int count);

}  // namespace internal
}  // namespace hypotrack
