#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Values at the points of a grid that are `inside` (8-bit), row by row, continued beyond by those
/// nearby, as an image of a tile's size (32-bit float).
HYPOTRACK_API cv::Mat spread(const cv::Mat& inside, const Eigen::VectorXf& values, cv::Size tile);

}  // namespace hypotrack
