#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

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

/// Returns whether the regions are nearly the same: centres, sides, and angles.
bool nearly_equal(const Region& a, const Region& b);

/// Returns the rotation from the region's axes to those of the picture.
Eigen::Matrix2d rotation_of(const Region& region);

/// Returns the region as an upright square picture of `side` pixels, black outside the picture.
cv::Mat cut_out(const cv::Mat& picture, const Region& region, int side);

}  // namespace hypotrack::hands
