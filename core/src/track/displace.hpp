#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// How far from a state another one lies.
struct Displacement {
  double metres = 0;   ///< of every model, in a direction of its own
  double radians = 0;  ///< of every model about its origin, about an axis of its own
  double angles = 0;   ///< standard deviation of every joint angle, radians
};

/// The state displaced within the parameters' bounds. Directions and axes are uniform, and all is a
/// function of the seed.
HYPOTRACK_API Eigen::VectorXd displaced(const Scene& scene, Eigen::VectorXd state,
                                        const Displacement& by, std::uint64_t seed);

}  // namespace hypotrack
