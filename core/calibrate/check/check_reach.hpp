#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "calibrate/board/board.hpp"
#include "calibrate/check/match_check.hpp"

namespace hypotrack::calibrate {

/// What a board of known size told.
enum class BoardReach {
  none,
  measured,    ///< its squares and corners under the given cameras
  calibrated,  ///< and the cameras that its pictures give by themselves
};

/// Where points were compared with a calibration, and so what the comparison cannot tell.
class CheckReach {
 public:
  /// Takes the points of one pair.
  void add(const MatchedPoints& points);

  /// Returns a line for everything of two cameras that no point tells.
  std::vector<std::string> blind_spots(const std::array<Camera, 2>& cameras,
                                       BoardReach board) const;

 private:
  std::array<BoardCorners, 2> pixels_;  ///< of all points
  std::vector<double> depths_;
  int pairs_ = 0, flat_ = 0;
};

}  // namespace hypotrack::calibrate
