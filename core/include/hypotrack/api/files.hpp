#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Returns the path of a file that comes with hypotrack (meshes, rigs, trackers). Looks
/// in HYPOTRACK_DATA_PATH if it is set, else in the installation or build tree. Throws DataError if
/// the file does not exist.
HYPOTRACK_API std::filesystem::path data_file(const std::filesystem::path& relative);

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

/// Returns why a library that does not say so could not write a file: its disk is full or
/// read-only, its folder may not be changed, or the file is too large. Empty if nothing of this is
/// seen.
HYPOTRACK_API std::string why_not_written(const std::filesystem::path& file);

}  // namespace hypotrack
