#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Reads a whole file, in large pieces. Returns nothing if it cannot be opened or read to its end.
HYPOTRACK_API std::optional<std::string> read_whole(const std::filesystem::path& file);

/// A text file that grows by whole lines. Every line is in the file when `write` returns, so that a
/// killed run loses no frame and other programs can follow it.
class HYPOTRACK_API TextFile {
 public:
  /// Throws OutputError.
  explicit TextFile(std::filesystem::path path);
  ~TextFile();
  TextFile(TextFile&& other) noexcept;
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  /// Appends a text, or nothing. Throws OutputError, for example on a full disk.
  void write(std::string_view text);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;    ///< -1 after a move
  std::int64_t size_ = 0;  ///< of the lines written
};

}  // namespace hypotrack
