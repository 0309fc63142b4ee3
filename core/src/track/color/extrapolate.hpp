#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Extrapolates values of grid points to a whole tile by normalised Gaussian blurring. The values
/// belong to the `inside` points (8-bit), row by row. Returns an image of the tile's size (32-bit
/// float).
cv::Mat extrapolate(const cv::Mat& inside, const Eigen::VectorXf& values, cv::Size tile);

}  // namespace internal
}  // namespace hypotrack
