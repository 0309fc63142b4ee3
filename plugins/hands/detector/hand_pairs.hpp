#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "hand_detection.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::hands {

/// A hand that both views show.
struct HandPair {
  HandPoints3D landmarks;  ///< in the world, metres
  double right = 0;        ///< probability that it is a right hand
  double error = 0;        ///< median distance of the reprojected landmarks, as a share of its size
};

/// Triangulates landmarks from two views: the points nearest to both rays. NaN where the rays do
/// not meet before the cameras.
HandPoints3D triangulate(const std::array<Camera, 2>& cameras, const HandPoints& first,
                         const HandPoints& second);

/// Pairs the hands of two views by the distance of their reprojected landmarks and by handedness,
/// best pairs first. A hand is in one pair at most.
std::vector<HandPair> pair_hands(const std::array<Camera, 2>& cameras,
                                 std::span<const HandDetection> first,
                                 std::span<const HandDetection> second);

}  // namespace hypotrack::hands
