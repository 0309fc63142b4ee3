#pragma once

#include <span>
#include <string>

#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// Describes a likely mistake in a pair of views; empty if there is none. Either the second of two
/// cameras with the same viewing direction is left of the first, or both views show the same image.
std::string problem_of_pair(std::span<const Camera> cameras, const Frame& frame);

}  // namespace hypotrack
