#pragma once

#include <Eigen/Core>
#include <optional>

#include "hypotrack/observation.hpp"

namespace hypotrack {

/// A moment of a motion.
struct Moment {
  double time = 0;        ///< s
  Eigen::VectorXd state;  ///< normalised
};

/// What a camera saw at a moment; nothing where there was no picture, or where the scene was not in
/// it.
using Sight = std::optional<Observation>;

}  // namespace hypotrack
