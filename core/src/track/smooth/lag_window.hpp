#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A state of a frame and its time.
struct TimedState {
  double time = 0;        ///< s
  Eigen::VectorXd state;  ///< normalised
};

/// Tiles of a frame; empty if it had no picture or the scene was not in view.
using FrameTiles = std::optional<Observation>;

}  // namespace internal
}  // namespace hypotrack
