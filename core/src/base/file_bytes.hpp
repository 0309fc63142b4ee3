#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The bytes of a file. Unlike a string's, its memory is not cleared before it is read into: that
/// takes as long as to read a picture that the system has in memory.
struct FileBytes {
  std::unique_ptr<char[]> memory;  ///< has room for one more byte
  std::size_t size = 0;

  std::string_view view() const { return {memory.get(), size}; }
};

/// Reads a whole file, in large pieces. Returns nothing if it cannot be opened or read to its end.
/// Throws std::system_error if the process has too many open files or too little memory.
std::optional<FileBytes> read_bytes(const std::filesystem::path& file);

/// Says why a path is no regular file: `no such file`, `is a folder`, `is a device`. Empty if it is
/// one.
std::string why_no_file(const std::filesystem::path& path);

}  // namespace internal
}  // namespace hypotrack
