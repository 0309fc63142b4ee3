#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/particle.hpp"

namespace hypotrack {

/// Computes K = 2 / |2 - psi - sqrt(psi^2 - 4 psi)| with psi = cognitive + social (Clerc and
/// Kennedy 2002). Throws ConfigError, naming `where`, unless psi > 4.
inline Constriction make_constriction(double cognitive, double social, const std::string& where) {
  const double psi = cognitive + social;
  if (!(psi > 4)) {
    throw ConfigError(where + ": cognitive + social is " + std::to_string(psi) +
                      ", expected above 4: the swarm is only constricted (and its search sure to "
                      "settle) there; the defaults are 2.8 and 1.3");
  }
  return {cognitive, social, 2.0 / std::abs(2.0 - psi - std::sqrt(psi * psi - 4.0 * psi))};
}

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
