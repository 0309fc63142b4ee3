#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "line_distribution.hpp"

namespace hypotrack::contour {

/// Refines the outline's place on a line of one-pixel segments. Pixels on the outline show a
/// mixture of both sides, which histograms take for background: a plain box then looks smaller by
/// a third of a pixel. So the share of the model in each pixel is found between the line's mean
/// colours on both sides of `place`. Lines of little contrast stay as they are. Where both ways
/// disagree, the variance grows.
/// `middle` is the line's middle in the image (BGR, 0 to 255), `normal` points outwards.
Place refine_place(const Place& place, const cv::Mat4f& color, const Eigen::Vector2f& middle,
                   const Eigen::Vector2f& normal);

}  // namespace hypotrack::contour
