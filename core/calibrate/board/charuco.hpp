#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "calibrate/board/board.hpp"

namespace hypotrack::calibrate {

/// Finds the markers and corners of a ChArUco board. charuco.cpp alone knows OpenCV's markers,
/// whose interface is another one from version 4.7 on.
class CharucoFinder {
 public:
  explicit CharucoFinder(const Board& board);
  ~CharucoFinder();
  /// Returns the corners between two markers each in a grey picture, in all patterns that fit.
  BoardCorners find(const cv::Mat& gray) const;
  /// Returns how many markers of the dictionary a grey picture has.
  std::size_t markers(const cv::Mat& gray) const;
  /// Returns where a corner is on the board, in metres.
  cv::Point3f place(int id) const;
  /// Draws the board with squares of some pixels on white, for tests.
  cv::Mat drawn(int square, int margin) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack::calibrate
