#pragma once

#include <filesystem>
#include <optional>

#include "base/descriptor.hpp"
#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A temporary folder, removed at the end. Its name has the number of the process, for a process
/// that is killed leaves it: the next one of the user removes it.
class ScratchFolder {
 public:
  /// Throws OutputError.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<Descriptor> lock_;  ///< tells processes that cannot see this one
};

}  // namespace internal
}  // namespace hypotrack
