#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "hypotrack/search.hpp"

namespace hypotrack {

// What an optimizer of a library needs around it: one unit for all dimensions, and costs that it
// can do arithmetic with.

/// The dimensions that the bounds of a region leave free, as offsets from the start in units of the
/// spread; the start is the origin.
class OffsetSpace {
 public:
  /// The region must outlive it.
  explicit OffsetSpace(const SearchRegion& region) : region_(region) {
    for (Eigen::Index d = 0; d < region.start.size(); ++d) {
      if (region.lower[d] < region.upper[d]) free_.push_back(d);
    }
  }

  /// Number of free dimensions.
  int dimension() const { return static_cast<int>(free_.size()); }
  /// The bounds, no further from the start than `box`; +-box may be infinite.
  Eigen::VectorXd lower(double box) const { return offsets(region_.lower).cwiseMax(-box); }
  Eigen::VectorXd upper(double box) const { return offsets(region_.upper).cwiseMin(box); }
  /// The search point of offsets, moved within the bounds.
  Eigen::VectorXd point(std::span<const double> offsets) const {
    Eigen::VectorXd point = region_.start;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      point[free_[i]] += region_.spread[free_[i]] * offsets[i];
    }
    return within_bounds(point, region_);
  }
  /// Offsets of a search point.
  Eigen::VectorXd offsets(const Eigen::Ref<const Eigen::VectorXd>& point) const {
    Eigen::VectorXd offsets(dimension());
    for (int i = 0; i < dimension(); ++i) {
      const Eigen::Index d = free_[static_cast<std::size_t>(i)];
      offsets[i] = (point[d] - region_.start[d]) / region_.spread[d];
    }
    return offsets;
  }

 private:
  const SearchRegion& region_;
  std::vector<Eigen::Index> free_;
};

/// Puts finite penalties in the place of infinite costs: clearly worse than anything seen, in the
/// scale of what was seen, so that models which an algorithm fits to its points stay usable.
class FiniteCosts {
 public:
  /// The penalty before any finite cost is known.
  static constexpr double kUnknown = 1e10;

  double of(double cost) {
    if (!std::isfinite(cost)) {
      if (worst_ < best_) return kUnknown;
      return worst_ + (worst_ - best_) + std::abs(worst_) + 1.0;
    }
    best_ = std::min(best_, cost);
    worst_ = std::max(worst_, cost);
    return cost;
  }
  /// The highest finite cost; -infinity before the first.
  double worst() const { return worst_; }

 private:
  double best_ = std::numeric_limits<double>::infinity();
  double worst_ = -std::numeric_limits<double>::infinity();
};

}  // namespace hypotrack
