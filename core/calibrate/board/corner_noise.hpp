#pragma once

#include <opencv2/core.hpp>

#include "calibrate/board/board_pair.hpp"

namespace hypotrack::calibrate {

/// Sharpness and noise of a picture at the edges between a board's corners.
struct EdgeLook {
  double blur = 0;      ///< standard deviation of the Gaussian that blurs edges, pixels
  double contrast = 0;  ///< grey levels between black and white
  double noise = 0;     ///< standard deviation, grey levels
};

/// Measures the edges between neighbouring corners; all 0 without such. `columns` is the number of
/// corners in a row of the board.
EdgeLook edge_look(const cv::Mat& gray, const BoardCorners& corners, int columns);

/// Returns the standard deviation of a corner's coordinate, in pixels, that edges allow.
double corner_sigma(const EdgeLook& edges);

/// Returns the root mean square distance of corners as sharp as a pair's from their places, in
/// pixels; 0: unknown.
double expected_distance(const BoardPair& pair);

}  // namespace hypotrack::calibrate
