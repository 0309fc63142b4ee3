#pragma once

#include <opencv2/core.hpp>

#include "calibrate/board/board.hpp"
#include "calibrate/board/marker_layout.hpp"

namespace hypotrack::calibrate {

/// Finds the corners between the markers of a picture.
class CornerFinder {
 public:
  /// `markers` must outlive the search. `square` is the side of a square in sides of a marker.
  CornerFinder(const cv::Mat& gray, const Markers& markers, double square);

  /// Returns the inner corners of a board that have both their markers in the picture, refined.
  PatternCorners corners(const MarkerLayout& layout, int rows) const;

 private:
  const Markers* markers_;
  double square_;
  cv::Mat squares_;  ///< the picture without markers, as that of a chessboard
};

}  // namespace hypotrack::calibrate
