#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <optional>

#include "calibrate/board/board.hpp"

namespace hypotrack::calibrate {

/// Where a board is before a camera that is not calibrated yet. Good to tell poses apart only.
struct RoughPose {
  Eigen::Vector2d centre;  ///< of its corners, as shares of the picture's width and height
  double extent = 0;       ///< the larger of its shares of the picture's width and height
  double distance = 0;     ///< metres
  Eigen::Vector3d normal;  ///< unit vector towards the camera: x right, y down, z forward
};

/// Returns the pose of a board before a lens of 60 degrees without distortion. Returns nothing for
/// fewer than four corners, or corners on a line.
std::optional<RoughPose> rough_pose(const BoardFinder& finder, const BoardCorners& corners,
                                    cv::Size picture);

/// Returns how much two poses differ: 1 is a tenth of the picture, 15 % of the distance or 10
/// degrees, whatever is most.
double difference(const RoughPose& a, const RoughPose& b);

}  // namespace hypotrack::calibrate
