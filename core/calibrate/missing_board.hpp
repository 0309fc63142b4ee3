#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "calibrate/board.hpp"

namespace hypotrack::calibrate {

/// Returns why no board is found in a picture, as a phrase: `too dark`, `blurred`, ...
std::string why_no_board(const BoardFinder& finder, const cv::Mat& picture);

}  // namespace hypotrack::calibrate
