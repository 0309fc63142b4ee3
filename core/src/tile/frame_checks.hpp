#pragma once

#include <vector>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws DataError unless a frame has a view per camera, with pictures of its size and of the
/// right types.
void check_views(const Frame& frame, const std::vector<Camera>& cameras);

}  // namespace internal
}  // namespace hypotrack
