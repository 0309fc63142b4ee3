#pragma once

#include <Eigen/Core>

#include "hand_detection.hpp"
#include "palm_detector.hpp"

namespace hypotrack::hands {

/// A turned square of a picture that holds one hand with its fingers up.
struct Region {
  Eigen::Vector2d center;  ///< pixels
  double side = 0;         ///< pixels
  double angle = 0;        ///< radians by which the hand is turned clockwise
};

/// Returns the region of the hand that a palm belongs to.
Region region_of(const Palm& palm);

/// Returns the region of the hand that has these landmarks.
Region region_of(const HandPoints& landmarks);

/// Returns whether the regions are nearly the same: centres and sides differ by less than this
/// share of the side of `a`, and angles by less than as many radians.
bool nearly_equal(const Region& a, const Region& b, double share);

/// Returns the rotation from the region's axes to those of the picture.
Eigen::Matrix2d rotation_of(const Region& region);

}  // namespace hypotrack::hands
