#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hypotrack/error.hpp"
#include "hypotrack/optimizer.hpp"
#include "hypotrack/random.hpp"

namespace hypotrack {

// What every optimizer needs around its algorithm.

/// For every dimension of a region the index of its group; empty where the region has no groups.
/// Throws Error unless every dimension is in exactly one.
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

/// Throws Error unless the region has the cost's dimension, bounds the right way round, a finite
/// start within them, positive spreads and groups (if any) that hold every dimension once, and the
/// budget allows the start to be evaluated.
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

/// A seed of its own for part `part` of a search: another optimizer that takes over, say.
constexpr std::uint64_t seed_of_part(std::uint64_t seed, std::uint32_t part) {
  constexpr std::uint32_t kPartStream = 0xffffffffu;  // no population draws from it
  const auto words =
      philox4x32({part, 0, 0, kPartStream},
                 {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return (std::uint64_t{words[1]} << 32) | words[0];
}

/// The nearest point within the bounds.
inline Eigen::VectorXd within_bounds(const Eigen::Ref<const Eigen::VectorXd>& point,
                                     const SearchRegion& region) {
  return point.cwiseMax(region.lower).cwiseMin(region.upper);
}

/// Remembers the best of all points evaluated and counts them. On equal costs the earlier one
/// stays, so that a flat objective leaves the search at its start.
class BestSoFar {
 public:
  /// Takes in points (DxN, N >= 1) and their costs (N).
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
  const OptimizerResult& result() const { return result_; }

 private:
  OptimizerResult result_;
};

/// The wall-clock side of a budget, running from its construction.
class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds) {}
  bool passed() const { return left() <= 0; }
  /// Seconds until it has passed.
  double left() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    return seconds_ - elapsed.count();
  }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace hypotrack
