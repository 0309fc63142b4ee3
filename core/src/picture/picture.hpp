#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// What to show of a view, 8-bit BGR: its colour (shared, not copied); without colour its depth in
/// grey, nearer is brighter, black where nothing was measured. Empty if the view has neither.
HYPOTRACK_API cv::Mat picture_of(const View& view);

}  // namespace hypotrack
