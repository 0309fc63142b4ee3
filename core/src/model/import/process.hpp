#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "hypotrack/export.hpp"

namespace hypotrack {

struct MeshReader {
  std::filesystem::path program;  ///< hypotrack_mesh_reader
  std::chrono::seconds time_limit{60};
};

/// The reader that belongs to this build or installation. Throws DataError, naming `mesh`, if it is
/// missing.
HYPOTRACK_API MeshReader default_mesh_reader(const std::filesystem::path& mesh);

/// Lets the reader program read `mesh` and returns the bytes that it wrote (wire.hpp).
/// Safe in a program with threads. Throws DataError, naming `mesh`, if the reader crashes, fails,
/// takes longer than its limit or writes more than 2 GiB.
HYPOTRACK_API std::string run_mesh_reader(const MeshReader& reader,
                                          const std::filesystem::path& mesh);

}  // namespace hypotrack
