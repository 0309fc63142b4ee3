#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// A text file that is written line by line. Every line is on disk when `write` returns, so that a
/// killed run loses no frame.
class HYPOTRACK_API TextFile {
 public:
  /// Throws OutputError.
  explicit TextFile(std::filesystem::path path);
  /// Throws OutputError, for example on a full disk.
  void write(std::string_view text);

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

/// Checks early that write_whole() can work for a file, for results of long work. Throws
/// OutputError if it cannot.
HYPOTRACK_API void expect_writable(const std::filesystem::path& file);

/// Writes a file beside its place and moves it there, so that it is never seen incomplete. Throws
/// OutputError.
HYPOTRACK_API void write_whole(const std::filesystem::path& file, std::string_view text);

}  // namespace hypotrack
