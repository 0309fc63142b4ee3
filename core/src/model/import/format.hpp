#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws DataError unless `file` exists, is at most 256 MiB and looks like OBJ, PLY, STL, DAE,
/// glTF or GLB. Checks the file name, the beginning and, for GLB, PLY and binary STL, the end. The
/// importer gets no other files. Returns notes on what the importer would leave out without a word.
std::vector<std::string> check_mesh_format(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack
