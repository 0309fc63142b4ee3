#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

namespace hypotrack {

/// Joints and fingertips of a hand in a picture, in pixels; pixel centres are at integers.
using HandPoints = Eigen::Matrix<double, 2, 21>;

/// Returns the diagonal of the box around a hand in a picture, in pixels.
inline double size_of(const HandPoints& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// Landmarks of a hand in space, metres.
using HandPoints3D = Eigen::Matrix<double, 3, 21>;

/// Names of the columns of HandPoints: the landmarks of hypotrack's hands.
inline constexpr std::array<std::string_view, 21> kHandPointNames = {
    "wrist",     "thumb_cmc", "thumb_mcp",  "thumb_ip",   "thumb_tip",  "index_mcp",  "index_pip",
    "index_dip", "index_tip", "middle_mcp", "middle_pip", "middle_dip", "middle_tip", "ring_mcp",
    "ring_pip",  "ring_dip",  "ring_tip",   "little_mcp", "little_pip", "little_dip", "little_tip"};

/// A hand that was found in a picture.
struct HandDetection {
  HandPoints landmarks;
  double palm_score = 0;  ///< of the palm's box, 0 to 1; that of HandDetector::refine() is 1
  double presence = 0;    ///< probability that there is a hand
  double right = 0;       ///< probability that it is a right hand, if the picture is not mirrored
  /// Shape of the hand in metres, about its own centre: x to the picture's right, y down, z away
  /// from the camera. The size is that of an average hand.
  HandPoints3D relative;
};

}  // namespace hypotrack
