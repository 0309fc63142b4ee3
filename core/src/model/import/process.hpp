#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

struct MeshReader {
  std::filesystem::path program;  ///< hypotrack_mesh_reader
  std::chrono::seconds time_limit{60};
};

/// Returns the reader program of this build or installation. Throws DataError, naming `mesh`, if it
/// is missing.
MeshReader default_mesh_reader(const std::filesystem::path& mesh);

/// Runs the reader program on `mesh` and returns the bytes that it wrote (wire.hpp). Safe in a
/// program with threads. Throws DataError, naming `mesh`, if the reader crashes, fails, exceeds its
/// time limit or writes more than 2 GiB.
std::string run_mesh_reader(const MeshReader& reader, const std::filesystem::path& mesh);

}  // namespace internal
}  // namespace hypotrack
