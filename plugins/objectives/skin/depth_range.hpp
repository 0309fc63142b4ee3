#pragma once

#include "hypotrack/plugin/observation.hpp"
#include "rule.hpp"

namespace hypotrack::skin {

/// Returns the range of the scene's depths in a camera, posed in observation.start and widened by
/// `margin` metres at both ends.
DepthRange depth_range(const Observation& observation, const TileCamera& camera, double margin);

}  // namespace hypotrack::skin
