#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/camera.hpp"

namespace hypotrack::depth_from_stereo {

/// Turns the pictures of two cameras so that a point has the same row in both and
/// z = focal_baseline / (x_first - x_second). OpenCV's stereoRectify (Bouguet's method: the turn is
/// shared out between the two cameras).
class RectifiedPair {
 public:
  /// Throws DataError, naming `where`, unless there are two cameras with images of one size and
  /// lenses of one kind, side by side rather than one above or before the other.
  RectifiedPair(const std::vector<Camera>& cameras, const std::string& where);

  /// The first camera, turned and without its lens; its centre is where it was.
  const Camera& camera() const { return camera_; }
  /// In pixels times metres; negative if the second camera is left of the first.
  double focal_baseline() const { return focal_baseline_; }

  /// A picture of camera 0 or 1 as the rectified camera sees it: bilinear, black outside.
  cv::Mat rectify(const cv::Mat& image, std::size_t camera) const;
  /// A mask of camera 0 or 1: that of the nearest pixel, 0 outside.
  cv::Mat rectify_mask(const cv::Mat& mask, std::size_t camera) const;
  /// Where a rectified picture shows what the camera saw: 8-bit, not zero there.
  const cv::Mat& seen(std::size_t camera) const { return seen_[camera]; }

 private:
  Camera camera_;
  double focal_baseline_ = 0;
  std::array<cv::Mat, 2> map_x_, map_y_, seen_;
};

}  // namespace hypotrack::depth_from_stereo
