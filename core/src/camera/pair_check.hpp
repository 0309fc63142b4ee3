#pragma once

#include <span>
#include <string>

#include "hypotrack/camera.hpp"

namespace hypotrack {

/// Describes a likely mistake in the calibration of two cameras with the same viewing direction:
/// the second is left of the first. Empty if there is none.
std::string problem_of_pair(std::span<const Camera> cameras);

}  // namespace hypotrack
