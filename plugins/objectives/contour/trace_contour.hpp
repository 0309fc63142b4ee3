#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "contour_views.hpp"
#include "hypotrack/camera.hpp"

namespace hypotrack::contour {

/// Traces the outline of a drawn model and returns about `count` points of it, evenly along it, in
/// the world's frame. `depth` is z in metres, 0 beside the model (32-bit float). Leaves out
/// corners, which have no normal. Holes have outlines, too.
std::vector<ContourPoint> trace_contour(const cv::Mat1f& depth, const Camera& camera, int count);

}  // namespace hypotrack::contour
