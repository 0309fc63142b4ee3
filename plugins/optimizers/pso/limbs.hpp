#pragma once

#include <vector>

#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

/// Numbers the groups of a region that are limbs, in their order.
struct Limbs {
  int count = 0;
  std::vector<int> of_dimension;  ///< -1 for a dimension in no limb

  explicit Limbs(const SearchRegion& region)
      : of_dimension(static_cast<std::size_t>(region.start.size()), -1) {
    for (const SearchGroup& group : region.groups) {
      if (group.kind != SearchGroup::Kind::limb) continue;
      for (const int d : group.dimensions) of_dimension[static_cast<std::size_t>(d)] = count;
      ++count;
    }
  }
};

}  // namespace hypotrack
