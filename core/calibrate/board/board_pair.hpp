#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "calibrate/board/board.hpp"

namespace hypotrack::calibrate {

/// The corners of a board in two pictures taken at the same time.
struct BoardPair {
  std::string name;
  std::array<BoardCorners, 2> corners;
};

/// Corners that both pictures of a pair show: on the board, in metres, and in the pictures.
struct SharedCorners {
  std::vector<cv::Point3f> board;
  std::array<std::vector<cv::Point2f>, 2> at;
};

constexpr std::size_t kLeastCorners = 6;  ///< that both pictures show, for a pose

/// Returns the corners that both pictures of a pair show.
SharedCorners shared_corners(const BoardFinder& board, const BoardPair& pair);

/// Returns whether a board is at the same place in both pairs, but for noise.
bool same_place(const BoardPair& one, const BoardPair& other);

}  // namespace hypotrack::calibrate
