#pragma once

#include <filesystem>
#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Returns why a library that does not say so could not write a file: its disk is full or
/// read-only, its folder may not be changed, or the file is too large. Empty if nothing of this is
/// seen.
HYPOTRACK_API std::string why_not_written(const std::filesystem::path& file);

}  // namespace hypotrack
