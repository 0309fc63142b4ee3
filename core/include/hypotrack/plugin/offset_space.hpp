#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

// Adapters for optimizers of third-party libraries: equal units in all dimensions and finite costs.

/// Search points as offsets from the start, in units of the spread, over the dimensions whose
/// bounds are not equal. The start is the origin.
class OffsetSpace {
 public:
  /// The region must outlive this object.
  explicit OffsetSpace(const SearchRegion& region) : region_(region) {
    for (Eigen::Index d = 0; d < region.start.size(); ++d) {
      if (region.lower[d] < region.upper[d]) free_.push_back(d);
    }
  }

  /// Returns the number of free dimensions.
  int dimension() const { return static_cast<int>(free_.size()); }
  /// Returns the bounds as offsets, at most `box` from the start; `box` may be infinite.
  Eigen::VectorXd lower(double box) const { return offsets(region_.lower).cwiseMax(-box); }
  Eigen::VectorXd upper(double box) const { return offsets(region_.upper).cwiseMin(box); }
  /// Returns the search point at these offsets, clamped to the bounds.
  Eigen::VectorXd point(std::span<const double> offsets) const {
    Eigen::VectorXd point = region_.start;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      point[free_[i]] += region_.spread[free_[i]] * offsets[i];
    }
    return within_bounds(point, region_);
  }
  /// Returns the offsets of a search point.
  Eigen::VectorXd offsets(const Eigen::Ref<const Eigen::VectorXd>& point) const {
    Eigen::VectorXd offsets(dimension());
    for (int i = 0; i < dimension(); ++i) {
      const Eigen::Index d = free_[static_cast<std::size_t>(i)];
      offsets[i] = (point[d] - region_.start[d]) / region_.spread[d];
    }
    return offsets;
  }
  /// Returns the entries of the free dimensions of a vector over all dimensions.
  Eigen::VectorXd free_part(const Eigen::VectorXd& all) const { return all(free_); }
  /// Returns the rows and columns of the free dimensions of a matrix over all dimensions.
  Eigen::MatrixXd free_block(const Eigen::MatrixXd& all) const { return all(free_, free_); }

 private:
  const SearchRegion& region_;
  std::vector<Eigen::Index> free_;
};

/// Replaces infinite costs by finite penalties above all costs seen so far. The penalty scales with
/// those costs, so that the models which an algorithm fits to its points stay usable.
class FiniteCosts {
 public:
  /// The penalty while no finite cost is known.
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
  /// Returns the highest finite cost; -infinity before the first.
  double worst() const { return worst_; }

 private:
  double best_ = std::numeric_limits<double>::infinity();
  double worst_ = -std::numeric_limits<double>::infinity();
};

}  // namespace hypotrack
