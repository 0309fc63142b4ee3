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

}  // namespace hypotrack
