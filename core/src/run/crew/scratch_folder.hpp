#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "base/exported.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A temporary folder, removed at the end.
class ScratchFolder {
 public:
  /// Throws OutputError.
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hypotrack_XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw OutputError(name + ": cannot make a temporary folder; set TMPDIR to one with room");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace internal
}  // namespace hypotrack
