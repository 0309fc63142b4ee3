#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/random.hpp"

namespace hypotrack {

// Helpers for optimizers.

/// Returns the group index of every dimension; empty if the region has no groups. Throws Error
/// unless every dimension is in exactly one group.
inline std::vector<int> group_of_dimension(const SearchRegion& region) {
  if (region.groups.empty()) return {};
  std::vector<int> group_of(static_cast<std::size_t>(region.start.size()), -1);
  for (std::size_t g = 0; g < region.groups.size(); ++g) {
    for (const int d : region.groups[g].dimensions) {
      if (d < 0 || d >= region.start.size() || group_of[static_cast<std::size_t>(d)] >= 0) {
        throw Error("search region: groups[" + std::to_string(g) + "] has dimension " +
                    std::to_string(d) + ", expected each of 0 to " +
                    std::to_string(region.start.size() - 1) + " in one group");
      }
      group_of[static_cast<std::size_t>(d)] = static_cast<int>(g);
    }
  }
  for (std::size_t d = 0; d < group_of.size(); ++d) {
    if (group_of[d] < 0) {
      throw Error("search region: dimension " + std::to_string(d) +
                  " is in no group, expected it in one (or no groups at all)");
    }
  }
  return group_of;
}

/// Throws if a region or budget is invalid: Error for the region, ConfigError for a budget below
/// one evaluation. The region needs the cost's dimension, a finite start within its bounds, and
/// positive spreads. Its groups, if any, must hold every dimension once.
inline void check_search(const CostFunction& cost, const SearchRegion& region,
                         const Budget& budget) {
  const Eigen::Index d = cost.dimension();
  if (d < 1 || region.start.size() != d || region.lower.size() != d || region.upper.size() != d ||
      region.spread.size() != d) {
    throw Error("search region: start, lower, upper and spread must have the cost's dimension, " +
                std::to_string(d));
  }
  for (Eigen::Index i = 0; i < d; ++i) {
    const double start = region.start[i];
    if (!std::isfinite(start) || !(region.lower[i] <= start && start <= region.upper[i])) {
      throw Error("search region: start[" + std::to_string(i) + "] is " + std::to_string(start) +
                  ", expected within its bounds [" + std::to_string(region.lower[i]) + ", " +
                  std::to_string(region.upper[i]) + "]");
    }
    if (!(region.spread[i] > 0) || !std::isfinite(region.spread[i])) {
      throw Error("search region: spread[" + std::to_string(i) + "] is " +
                  std::to_string(region.spread[i]) + ", expected positive and finite");
    }
  }
  (void)group_of_dimension(region);
  if (budget.evaluations < 1) {
    throw ConfigError("budget: " + std::to_string(budget.evaluations) +
                      " evaluations, expected at least 1 (the start is always evaluated)");
  }
}

/// Derives an independent seed for part `part` of a search, such as another optimizer's.
constexpr std::uint64_t seed_of_part(std::uint64_t seed, std::uint32_t part) {
  constexpr std::uint32_t kPartStream = 0xffffffffu;  // no population draws from it
  const auto words =
      philox4x32({part, 0, 0, kPartStream},
                 {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return (std::uint64_t{words[1]} << 32) | words[0];
}

/// Clamps a point to the region's bounds.
inline Eigen::VectorXd within_bounds(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const SearchRegion& region) {
  return point.cwiseMax(region.lower).cwiseMin(region.upper);
}

/// Keeps the best of all points evaluated and counts them. Among equal costs the earliest point
/// wins, so that a flat objective leaves the search at its start.
class BestSoFar {
 public:
  /// Adds points (DxN, N >= 1) with their costs (N).
  void update(const Eigen::Ref<const Eigen::MatrixXd>& points,
              const Eigen::Ref<const Eigen::VectorXd>& costs) {
    Eigen::Index best = 0;
    const double cost = costs.minCoeff(&best);
    if (result_.evaluations == 0 || cost < result_.cost) {
      result_.cost = cost;
      result_.point = points.col(best);
    }
    result_.evaluations += costs.size();
  }
  /// Counts evaluations that returned no costs: those of linearize().
  void count(std::int64_t evaluations) { result_.evaluations += evaluations; }
  const OptimizerResult& result() const { return result_; }

 private:
  OptimizerResult result_;
};

/// The clock of a search's time limit: wall time, or CPU time of the whole process.
enum class SearchClock { wall, cpu };

/// Returns the clock that limits the search on this thread: `budget.seconds` or
/// `budget.cpu_seconds`.
HYPOTRACK_API SearchClock search_clock();

/// Returns the time of a clock in seconds.
HYPOTRACK_API double seconds_of(SearchClock clock);

/// A time limit that starts at construction, on the clock of the search.
class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds) {}
  bool passed() const { return left() <= 0; }
  /// Returns the remaining seconds; negative once passed.
  double left() const { return seconds_ - (seconds_of(clock_) - begin_); }

 private:
  double seconds_;
  SearchClock clock_ = search_clock();
  double begin_ = seconds_of(clock_);
};

}  // namespace hypotrack
