#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Size of a random displacement of a state.
struct Displacement {
  double metres = 0;   ///< of every model, in a random direction
  double radians = 0;  ///< of every model about its origin, about a random axis
  double angles = 0;   ///< standard deviation of every joint angle, radians
};

/// Returns the state displaced randomly within the parameters' bounds. Directions and axes are
/// uniform. The result depends on the arguments only.
Eigen::VectorXd displaced(const Scene& scene, Eigen::VectorXd state, const Displacement& by,
                          std::uint64_t seed);

}  // namespace internal
}  // namespace hypotrack
