#pragma once

#include "board_options.hpp"
#include "calibrate/picture_pairs.hpp"
#include "hypotrack/api/calibration.hpp"

namespace hypotrack::app {

/// Compares pictures with a calibration and prints what they tell and what they do not: matches of
/// any scene, and a board if one is given. Returns the exit code.
int check_calibration(const CalibrationSettings& settings, const calibrate::PairFiles& files,
                      const BoardOptions& board);

}  // namespace hypotrack::app
