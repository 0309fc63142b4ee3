#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <vector>

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

/// Returns the sides in pixels of square tiles in which to look for ever smaller hands, down to
/// those `smallest_hand` pixels long; 0: none.
std::vector<int> tile_sides(const cv::Size& picture, double smallest_hand);

/// Returns tiles of that side that overlap by half or more and cover the picture.
std::vector<cv::Rect> tiles(const cv::Size& picture, int side);

}  // namespace hypotrack::hands
