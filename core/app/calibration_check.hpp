#pragma once

#include <optional>
#include <string>

#include "board_options.hpp"
#include "hypotrack/calibration.hpp"

namespace hypotrack::app {

/// Compares pictures with a calibration and prints what they tell and what they do not: matches of
/// any scene, and a board if one is given. Returns the exit code.
int check_calibration(CalibrationSettings settings, const std::string& left,
                      const std::string& right, const BoardOptions& board);

}  // namespace hypotrack::app
