#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <vector>

#include "calibrate/board/board_pair.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::calibrate {

/// Corners of a pair, which has an index among the given ones.
struct CommonCorners : SharedCorners {
  std::size_t pair = 0;
};

/// One camera's matrix and distortion, as OpenCV has them.
struct Lens {
  cv::Mat matrix, distortion;
};

/// Returns the corners that both pictures show of the pairs with enough of them.
std::vector<CommonCorners> common_corners(const BoardFinder& board,
                                          const std::vector<BoardPair>& pairs);

Lens lens_of(const Camera& camera);
Camera camera_of(const Lens& lens, cv::Size pictures);

/// Calibrates each camera alone. `focal_sigma`: standard deviations of the focal lengths as shares
/// of them.
void calibrate_lenses(const std::vector<CommonCorners>& views, cv::Size pictures,
                      std::array<Lens, 2>& lenses, std::array<double, 2>& focal_sigma);

/// The right camera's pose, the residuals of each view, and those of all corners.
struct StereoSolution {
  cv::Mat rotation, translation, residuals;
  double rms = 0;
};

/// Calibrates both cameras together, and refines `lenses` unless OpenCV's `flags` fix them.
StereoSolution calibrate_both(const std::vector<CommonCorners>& views, cv::Size pictures,
                              std::array<Lens, 2>& lenses, int flags);

/// Returns the pose of a board before a camera.
cv::Affine3d pose_of(const CommonCorners& view, std::size_t camera, const Lens& lens);

/// Returns the root mean square distance of a picture's corners from those of a board in a pose,
/// in pixels.
double distance_of(const CommonCorners& view, std::size_t camera, const Lens& lens,
                   const cv::Affine3d& pose);

/// Where boards are before the left camera, and the right camera from it as most of them tell.
struct CommonPose {
  std::vector<cv::Affine3d> boards;
  cv::Affine3d right_from_left;
  std::vector<double> distances;  ///< of the right pictures' corners from that, pixels
};

/// Returns the pose of the view that most agree with (least median of squares: Rousseeuw 1984).
CommonPose common_pose(const std::vector<CommonCorners>& views, const std::array<Lens, 2>& lenses);

}  // namespace hypotrack::calibrate
