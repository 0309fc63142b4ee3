#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hypotrack/api/stop.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/random.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {

/// Parameters of a population's first points; an optimizer's parameter struct includes them.
struct StartParams : StartDistribution {
  void visit(ParamVisitor& v) {
    v("sigma", sigma,
      {.help = "standard deviation of the first points about the start, as a share of the search "
               "region's spread",
       .min = 0,
       .max = 10});
    v("group_share", group_share,
      {.help = "share of the groups (a model's pose, a limb) that a first point moves by all of "
               "sigma; the others move by group_rest of it",
       .min = 0,
       .max = 1});
    v("group_rest", group_rest,
      {.help = "share of sigma for the groups that group_share leaves out", .min = 0, .max = 1});
  }
};

/// Returns the group index of every dimension; without groups, each dimension is its own group.
inline std::vector<int> groups_or_dimensions(const SearchRegion& region) {
  std::vector<int> group_of = group_of_dimension(region);
  for (Eigen::Index d = 0; group_of.size() < static_cast<std::size_t>(region.start.size()); ++d) {
    group_of.push_back(static_cast<int>(d));
  }
  return group_of;
}

/// The numbered first points of a population. Point 0 is the start; the others are normal samples
/// about it, clamped to the bounds. Point k is a function of (region, starts, seed, k).
class StartPoints {
 public:
  /// The region must outlive this object.
  StartPoints(const SearchRegion& region, const StartDistribution& starts, std::uint64_t seed)
      : region_(region), starts_(starts), seed_(seed), group_of_(groups_or_dimensions(region)) {}

  /// Returns points `first` to `first + count - 1` (DxN).
  Eigen::MatrixXd points(std::int64_t first, std::int64_t count) const {
    Eigen::MatrixXd points = region_.start.replicate(1, count);
    for (std::int64_t i = first == 0 ? 1 : 0; i < count; ++i) {
      if (i % 4096 == 0) check_stop();
      for (Eigen::Index d = 0; d < points.rows(); ++d) {
        points(d, i) = sample(d, static_cast<std::uint32_t>(first + i));
      }
    }
    return points;
  }

 private:
  double sample(Eigen::Index d, std::uint32_t number) const {
    const auto group = static_cast<std::uint32_t>(group_of_[static_cast<std::size_t>(d)]);
    return start_sample(
        region_.start[d], region_.spread[d] * starts_.of_group(seed_, group, number),
        {region_.lower[d], region_.upper[d]}, seed_, static_cast<std::uint32_t>(d), number);
  }

  const SearchRegion& region_;
  StartDistribution starts_;
  std::uint64_t seed_;
  std::vector<int> group_of_;
};

}  // namespace hypotrack
