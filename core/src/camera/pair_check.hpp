#pragma once

#include <span>
#include <string>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// What looks like a mistake in a pair of views, in words: the second camera of two that look the
/// same way stands to the left of the first, or both views show one picture. Empty if nothing does.
HYPOTRACK_API std::string problem_of_pair(std::span<const Camera> cameras, const Frame& frame);

}  // namespace hypotrack
