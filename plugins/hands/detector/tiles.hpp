#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

namespace hypotrack::hands {

/// Returns the sides in pixels of square tiles in which to look for ever smaller hands, down to
/// those `smallest_hand` pixels long; 0: none.
std::vector<int> tile_sides(const cv::Size& picture, double smallest_hand);

/// Returns tiles of that side that overlap by half or more and cover the picture.
std::vector<cv::Rect> tiles(const cv::Size& picture, int side);

}  // namespace hypotrack::hands
