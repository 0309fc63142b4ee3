#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "hypotrack/scene.hpp"

namespace hypotrack {

/// The state with every model moved by `metres` in a direction of its own and turned about its
/// origin by `radians` about an axis of its own. Directions and axes are uniform, and a function of
/// the seed.
Eigen::VectorXd displaced(const Scene& scene, Eigen::VectorXd state, double metres, double radians,
                          std::uint64_t seed);

}  // namespace hypotrack
