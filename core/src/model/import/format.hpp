#pragma once

#include <filesystem>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Throws DataError unless `file` exists, is at most 256 MiB, is OBJ, PLY, STL, glTF or GLB by its
/// name, and begins (and, for GLB, PLY and binary STL, ends) like one. Nothing else is given to the
/// importer.
HYPOTRACK_API void check_mesh_format(const std::filesystem::path& file);

}  // namespace hypotrack
