#pragma once

#include <filesystem>
#include <string>

#include "base/exported.hpp"
#include "session/scene_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Copies the files that a scene's start reads into a folder, as start_NAME. Returns `init` as YAML
/// that names the copies; a file that does not exist keeps its absolute path. Throws OutputError.
std::string copy_start_files(const InitSettings& init, const std::filesystem::path& folder);

}  // namespace internal
}  // namespace hypotrack
