#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws lines and points on an 8-bit BGR image, with a dark edge so that they show on any ground.
/// Coordinates are pixels with centres at integers. NaN and far outside: not drawn.
class Pen {
 public:
  /// Draws on `image`, which must outlive the pen.
  explicit Pen(cv::Mat& image);

  /// Draws the pieces of a line (2xN) that lie near the image; NaN points interrupt it.
  void line(const Eigen::Matrix2Xd& points, const cv::Scalar& color);
  void dot(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name);
  /// Draws a small cross, which shows the pixel in its middle.
  void cross(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name);

 private:
  bool is_near(const Eigen::Vector2d& p) const;
  void label(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name);

  cv::Mat& image_;
  int width_;
};

/// Joins 8-bit BGR images side by side, with lines of text below.
cv::Mat side_by_side(const std::vector<cv::Mat>& images, std::span<const std::string> text);

}  // namespace internal
}  // namespace hypotrack
