#pragma once

#include <span>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Describes a likely mistake in the calibration of two cameras with the same viewing direction:
/// the second is left of the first. Empty if there is none.
std::string problem_of_pair(std::span<const Camera> cameras);

}  // namespace internal
}  // namespace hypotrack
