#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using GreyPair = std::array<cv::Mat1b, 2>;

/// Makes small grey pictures of a pair of cameras in which points have the same row.
class RectifiedPair {
 public:
  /// Returns nothing for cameras that are not nearly parallel (make_ideal_rig()).
  static std::optional<RectifiedPair> make(const std::array<Camera, 2>& cameras);

  /// Resamples the first two views of a frame, 8-bit BGR.
  GreyPair resample(const Frame& frame) const;

  double focal() const { return focal_; }
  Eigen::Vector2d center() const { return center_; }
  /// Disparity, in pixels, at a distance in metres.
  double disparity(double distance) const { return focal_ * baseline_ / distance; }
  /// Pixels of the second camera's pictures per pixel.
  double scale() const { return second_.fx / focal_; }
  /// Returns the second camera's pixels where a displacement of what it shows is undone: a rotation
  /// (radians, clockwise) and a scale about the optical axis, then a shift in small pixels.
  cv::Matx33d displacement(double roll, double scale, const Eigen::Vector2d& shift) const;
  /// Returns the second camera's pixels where a turn (CameraTurn, radians) is undone, without lens
  /// distortion.
  cv::Matx33d turned(double angle) const;

 private:
  double focal_ = 0, baseline_ = 0;  ///< pixels, metres
  Eigen::Vector2d center_;
  Camera second_;
  Eigen::Matrix3d second_from_ideal_;            ///< directions
  int shrink_ = 1;                               ///< pixels of a picture that are averaged
  std::array<cv::Mat, 2> x_, y_;                 ///< in the shrunken pictures
  std::array<std::optional<cv::Rect>, 2> part_;  ///< of those, where no pixel is between others
};

}  // namespace internal
}  // namespace hypotrack
