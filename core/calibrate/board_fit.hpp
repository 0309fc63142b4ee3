#pragma once

#include <array>
#include <optional>

#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {

/// A board in both pictures as calibrated cameras measure it.
struct BoardFit {
  double scale = 1;     ///< measured side of a square as a share of the given one
  double rms = 0;       ///< distance of the corners from the board in the pictures, pixels
  double expected = 0;  ///< of corners as sharp as these, pixels; 0: unknown
  double depth = 0;     ///< of the board's middle before the left camera, metres
  cv::Point2d centre;   ///< in the left picture, as shares of its width and height
};

/// Fits a board of unknown scale to both pictures of a pair by least squares. Returns nothing for
/// few common corners, or if their rays do not meet before the cameras.
std::optional<BoardFit> fit_board(const BoardFinder& finder, const std::array<Camera, 2>& cameras,
                                  const BoardPair& pair);

}  // namespace hypotrack::calibrate
