#pragma once

#include <filesystem>

#include "base/exported.hpp"
#include "hypotrack/image_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Decodes a file's pixels as stored, and turns them as viewers do. Throws if memory lacks.
ReadImage decode_upright(const std::filesystem::path& file);

/// Returns the orientation_of() a file; 0 if it cannot be read.
int file_orientation(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack
