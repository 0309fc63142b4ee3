#pragma once

#include <cstdint>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "tile/tiles.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/tracker_parts.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws ConfigError if models are to be looked for that cannot be.
void check_looking(const TrackerParts& parts, bool recovers);

/// Subtracts the evaluations of fixed-lag smoothing and of sigmas from a search's budget. Throws
/// ConfigError if less than half would be left.
void reserve_evaluations(const FixedLagSettings& smoothing, std::int64_t of_sigmas, Budget& budget);

/// Returns a warning if frames like this one would count as lost or uncertain at a state; empty
/// otherwise. The frame must be usable.
std::string problem_of_start(const Frame& frame, const Eigen::VectorXd& state,
                             const TileMaker& tiles, double min_visible);

}  // namespace internal
}  // namespace hypotrack
