#pragma once

#include <Eigen/Core>
#include <optional>

#include "hypotrack/observation.hpp"

namespace hypotrack {

/// A state of a motion and its time.
struct Moment {
  double time = 0;        ///< s
  Eigen::VectorXd state;  ///< normalised
};

/// Tiles of a moment; nothing if there was no picture or the scene was not in view.
using Sight = std::optional<Observation>;

}  // namespace hypotrack
