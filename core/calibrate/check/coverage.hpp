#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {

/// Share of a picture's cells in which a corner was seen, and where cells lack one.
struct Coverage {
  double share = 0;
  std::vector<std::string> empty;  ///< `top left`, `right`, ...
};

/// Share of a picture's cells that a good calibration needs.
constexpr double kEnoughCoverage = 0.6;

/// Returns the coverage of pictures of one size by the corners of boards.
Coverage coverage_of(std::span<const BoardCorners* const> boards, cv::Size picture);

/// Returns the coverage of the left (0) or right (1) pictures by pairs that count.
Coverage coverage_of(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration,
                     std::size_t view);

/// Draws the corners of all pairs, both pictures side by side: green, or red where a pair
/// does not count.
cv::Mat draw_coverage(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration);

}  // namespace hypotrack::calibrate
