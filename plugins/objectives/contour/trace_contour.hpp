#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hypotrack::contour {

/// A point of an outline in a picture, in pixels.
struct TracedPoint {
  Eigen::Vector2f position;  ///< on the edge, between the pixels
  Eigen::Vector2f normal;    ///< unit, outwards
  float depth;               ///< of the border pixel beside it
  float inside, outside;     ///< length along the normal with the model, and without it
};

/// Traces the outline of a drawn model and returns about `count` points, evenly along it. `depth`
/// is 0 beside the model. Leaves out corners, which have no normal. Holes have outlines, too.
std::vector<TracedPoint> trace_contour(const cv::Mat1f& depth, int count);

}  // namespace hypotrack::contour
