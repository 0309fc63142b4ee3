#pragma once

#include <filesystem>
#include <vector>

#include "boards/board_options.hpp"
#include "calibrate/picture_pairs.hpp"
#include "hypotrack/api/calibration.hpp"

namespace hypotrack::app {

/// Throws OutputError if a file exists, unless it may be replaced.
void check_new_file(const std::filesystem::path& file, bool replace);

/// Writes cameras in hypotrack's form, as a whole or not at all. Throws OutputError.
void write_calibration(const std::filesystem::path& file, const std::vector<Camera>& cameras);

/// Prints sizes, lenses and fields of view of cameras, and how they stand to each other.
void print_cameras(const std::vector<NamedCamera>& cameras);

/// Compares pictures with a calibration and prints what they tell and what they do not: matches of
/// any scene, and a board if one is given. Returns the exit code.
int check_calibration(const CalibrationSettings& settings, const calibrate::PairFiles& files,
                      const BoardOptions& board);

}  // namespace hypotrack::app
