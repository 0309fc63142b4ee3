#pragma once

#include <filesystem>
#include <optional>

#include "base/exported.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// An exclusive lock between processes, on one machine or over a network file system. The kernel
/// frees it when its last owner ends, however it ends. It is a file (flock) whose content tells
/// people who holds it.
class FileLock {
 public:
  /// Waits until the lock is free and takes it. Throws OutputError if the file cannot be made or
  /// locked.
  static FileLock wait_for(const std::filesystem::path& file);
  /// Takes the lock. Returns nothing if another process, or another FileLock, holds it.
  static std::optional<FileLock> try_take(const std::filesystem::path& file);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  /// Removes the file and frees the lock.
  ~FileLock();

  /// Returns the file descriptor, for a child process that must keep the lock while it lives.
  int descriptor() const { return descriptor_; }

 private:
  FileLock(std::filesystem::path file, int descriptor);
  static std::optional<FileLock> take(const std::filesystem::path& file, bool wait);
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace internal
}  // namespace hypotrack::study
