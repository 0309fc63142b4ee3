#pragma once

#include <filesystem>
#include <vector>

#include "hypotrack/api/calibration.hpp"

namespace hypotrack::app {

/// Throws OutputError if a file exists, unless it may be replaced.
void check_new_file(const std::filesystem::path& file, bool replace);

/// Writes cameras in hypotrack's form, as a whole or not at all. Throws OutputError.
void write_calibration(const std::filesystem::path& file, const std::vector<Camera>& cameras);

/// Prints sizes, lenses and fields of view of cameras, and how they stand to each other.
void print_cameras(const std::vector<NamedCamera>& cameras);

}  // namespace hypotrack::app
