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
  /// Throws OutputError, a full disk for example.
  void write(std::string_view text);

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

/// For what is written after long work: throws OutputError if write_whole() has no chance there.
HYPOTRACK_API void expect_writable(const std::filesystem::path& file);

/// Writes beside the file and moves into place, so that nobody sees half of it. Throws OutputError.
HYPOTRACK_API void write_whole(const std::filesystem::path& file, std::string_view text);

}  // namespace hypotrack
