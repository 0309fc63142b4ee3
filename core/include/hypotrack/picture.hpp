#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// Returns a displayable image of a view, 8-bit BGR: its colour (shared, not copied), else its
/// depth in grey. Nearer depth is brighter; unmeasured depth is black. Empty if the view has
/// neither.
HYPOTRACK_API cv::Mat picture_of(const View& view);

}  // namespace hypotrack
