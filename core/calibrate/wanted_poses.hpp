#pragma once

#include <array>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "calibrate/board/rough_pose.hpp"
#include "calibrate/check/coverage.hpp"

namespace hypotrack::calibrate {

/// How well pairs of a board fill both pictures and the poses before them.
struct PoseCoverage {
  std::array<Coverage, 2> pictures;  ///< left and right
  int tilts = 0;                     ///< of the board, of kTilts directions
  std::vector<std::string> wanted;   ///< what to do next: `board farther away`, ...
  static constexpr int kTilts = 4;
};

/// Returns what pairs cover and what they lack for a good calibration. `poses` are those of the
/// boards in the left pictures.
PoseCoverage pose_coverage(const std::vector<BoardPair>& pairs, const std::vector<RoughPose>& poses,
                           cv::Size picture);

}  // namespace hypotrack::calibrate
