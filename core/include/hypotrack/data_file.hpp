#pragma once

#include <filesystem>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Returns the path of a file that comes with hypotrack (meshes, rigs, trackers). Looks
/// in HYPOTRACK_DATA_PATH if it is set, else in the installation or build tree. Throws DataError if
/// the file does not exist.
HYPOTRACK_API std::filesystem::path data_file(const std::filesystem::path& relative);

}  // namespace hypotrack
