#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::depth_from_stereo {

/// Rectifies the pictures of two cameras, so that a point has the same row in both and z =
/// focal_baseline / (x_first - x_second). Uses OpenCV's stereoRectify (Bouguet's method: both
/// cameras are rotated by half).
class RectifiedPair {
 public:
  /// Throws DataError, naming `where`, unless there are two cameras with images of one size and
  /// lenses of one kind. They must be side by side rather than one above or in front of the other.
  RectifiedPair(const std::vector<Camera>& cameras, const std::string& where);

  /// Returns the first camera, rotated and without its lens; its centre is unchanged.
  const Camera& camera() const { return camera_; }
  /// Returns focal length times baseline, in pixels times metres; negative if the second camera is
  /// left of the first.
  double focal_baseline() const { return focal_baseline_; }

  /// Warps a picture of camera 0 or 1 to the rectified camera: bilinear, black outside.
  cv::Mat rectify(const cv::Mat& image, std::size_t camera) const;
  /// Warps a mask of camera 0 or 1: nearest pixel, 0 outside.
  cv::Mat rectify_mask(const cv::Mat& mask, std::size_t camera) const;
  /// Returns where a rectified picture shows what the camera saw: 8-bit, not zero there.
  const cv::Mat& seen(std::size_t camera) const { return seen_[camera]; }

 private:
  Camera camera_;
  double focal_baseline_ = 0;
  std::array<cv::Mat, 2> map_x_, map_y_, seen_;
};

}  // namespace hypotrack::depth_from_stereo
