#pragma once

#include "hypotrack/observation.hpp"
#include "rule.hpp"

namespace hypotrack::skin {

/// The depths that the scene has for a camera as it is posed in observation.start, widened by
/// `margin` metres at both ends.
DepthRange depth_range(const Observation& observation, const TileCamera& camera, double margin);

}  // namespace hypotrack::skin
