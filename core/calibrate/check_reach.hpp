#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "calibrate/board.hpp"
#include "calibrate/match_check.hpp"

namespace hypotrack::calibrate {

/// Where points were compared with a calibration, and so what the comparison cannot tell.
class CheckReach {
 public:
  /// Takes the points of one pair.
  void add(const MatchedPoints& points);

  /// Returns a line for everything of two cameras that no point tells. `measured`: a board of known
  /// size was measured.
  std::vector<std::string> blind_spots(const std::array<Camera, 2>& cameras, bool measured) const;

 private:
  std::array<BoardCorners, 2> pixels_;  ///< of all points
  std::vector<double> depths_;
  int pairs_ = 0, flat_ = 0;
};

}  // namespace hypotrack::calibrate
