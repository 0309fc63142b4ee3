#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns true for UTF-8 without noncharacters, which yaml-cpp writes as others.
bool is_text(std::string_view text);

/// Reads a file, or a little more than the limit of a larger one. Throws ConfigError if it cannot.
std::string read_text_file(const std::filesystem::path& file);

/// A text with its line starts; converts the parser's byte columns to character columns.
class YamlText {
 public:
  /// Skips a byte order mark. Throws ConfigError on texts over 8 MiB, invalid UTF-8, noncharacters
  /// and control characters, because yaml-cpp takes U+0004 for the end of the text.
  YamlText(std::string_view text, const YamlOrigin& origin);

  std::string_view text() const { return text_; }

  struct Position {
    int line;
    int column;
  };
  /// Returns the 1-based position in characters of a 0-based line and byte.
  Position position(int line, int byte) const;
  /// Returns the text from a 0-based line and byte on.
  std::string_view from(int line, int byte) const;

 private:
  void check(const YamlOrigin& origin) const;

  std::string_view text_;
  std::vector<std::size_t> line_starts_;
  // Result of the last call, from which the next one continues. Nearly all calls move forward, and
  // one line may be the whole text.
  mutable std::size_t known_line_ = 0;
  mutable std::size_t known_byte_ = 0;  ///< in the line
  mutable std::size_t known_characters_ = 0;
};

}  // namespace internal
}  // namespace hypotrack::detail
