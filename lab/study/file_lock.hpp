#pragma once

#include <filesystem>
#include <optional>

#include "hypotrack/export.hpp"

namespace hypotrack::study {

/// An exclusive lock that the kernel gives back when its last owner ends, however it ends:
/// processes that work on one folder, on one machine or over a network file system, keep apart by
/// it. It is a file (flock), whose content tells people who holds it.
class HYPOTRACK_API FileLock {
 public:
  /// Waits until the lock is free. Throws OutputError if the file cannot be made or locked.
  static FileLock wait_for(const std::filesystem::path& file);
  /// Nothing if another process, or another FileLock, holds it.
  static std::optional<FileLock> try_take(const std::filesystem::path& file);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  /// Removes the file and frees the lock.
  ~FileLock();

  /// For a child process that is to keep the lock while it lives.
  int descriptor() const { return descriptor_; }

 private:
  FileLock(std::filesystem::path file, int descriptor);
  static std::optional<FileLock> take(const std::filesystem::path& file, bool wait);
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace hypotrack::study
