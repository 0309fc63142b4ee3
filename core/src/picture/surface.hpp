#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The nearest surface at the pixels of a pinhole camera.
struct Surface {
  explicit Surface(const cv::Size& size);

  /// Computes the slopes of a surface whose triangles have about `facet` pixels across.
  void find_slopes(double facet);
  /// Returns the smoothed slopes of inverse depth along x and y, per pixel.
  Eigen::Vector2f slopes_at(cv::Point pixel) const;

  cv::Mat1f inverse_depth;  ///< 1/m; 0 = nothing
  cv::Mat1b label;          ///< 0 = nothing, else 1 + index of the model

 private:
  cv::Mat3f slopes_;  ///< weighted, along x and y; then the weight
};

}  // namespace internal
}  // namespace hypotrack
