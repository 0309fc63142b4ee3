#pragma once

#include <atomic>
#include <opencv2/core.hpp>
#include <vector>

namespace hypotrack::calibrate {

/// A chessboard, or a part of one, of a size that was not asked for.
struct SeenChessboard {
  cv::Size size;                ///< inner corners; empty: none is seen
  std::vector<cv::Point2f> at;  ///< row by row, rows clockwise from columns
  bool whole = false;           ///< the squares around the corners are in the picture, too
};

/// Returns the largest chessboard in a grey picture.
SeenChessboard largest_chessboard(const cv::Mat& gray);

/// Inner corners of a chessboard in a picture.
struct ChessboardCorners {
  std::vector<cv::Point2f> at;  ///< row by row; empty: not found
  cv::Size seen;                ///< of a whole board of any size in the picture; empty: unknown
};

/// Finds a whole chessboard of a size in a grey picture, in a copy of 640 pixels of width first.
/// `quickly`: with the fast searches only, and `seen` is known only where the board is not found.
/// Otherwise, each slow search that fails takes one from `slow_searches`; at 0 there are none.
ChessboardCorners find_chessboard(const cv::Mat& gray, cv::Size size, bool quickly,
                                  std::atomic<int>& slow_searches);

}  // namespace hypotrack::calibrate
