#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// A text with the places of its lines.
class Lines {
 public:
  explicit Lines(const std::string& text) : text_(text) {
    const std::size_t mark = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // of UTF-8, in no column
    for (std::size_t at = mark; at != std::string::npos && at < text.size();) {
      begins_.push_back(at);
      at = text.find('\n', at);
      if (at != std::string::npos) ++at;
    }
    begins_.push_back(text.size());
  }

  /// Returns the index of a character, both numbers from 1.
  std::size_t at(int line, int column) const {
    std::size_t i = begin(line);
    for (int c = 1; c < column && i < text_.size(); ++c) {
      ++i;
      while (i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xC0) == 0x80) ++i;
    }
    return i;
  }
  std::size_t begin(int line) const {
    const auto index = static_cast<std::size_t>(line - 1);
    return index < begins_.size() ? begins_[index] : text_.size();
  }
  int count() const { return static_cast<int>(begins_.size()) - 1; }
  std::string of(int first, int end) const {
    return text_.substr(begin(first), begin(end) - begin(first));
  }
  /// Returns the number of spaces before a line's text; nothing if it has none but a comment.
  std::optional<int> indent(int line) const {
    const std::size_t first = text_.find_first_not_of(" \t", begin(line));
    if (first == std::string::npos || first >= begin(line + 1)) return std::nullopt;
    if (text_[first] == '\n' || text_[first] == '\r' || text_[first] == '#') return std::nullopt;
    return static_cast<int>(first - begin(line));
  }

 private:
  const std::string& text_;
  std::vector<std::size_t> begins_;
};

/// Moves the lines of a chunk to the left.
inline std::string dedented(const std::string& chunk, int by) {
  std::string out;
  const Lines lines(chunk);
  for (int line = 1; line <= lines.count(); ++line) {
    const std::string text = lines.of(line, line + 1);
    const std::size_t spaces = std::min(text.find_first_not_of(' '), text.size());
    out += text.substr(std::min(spaces, static_cast<std::size_t>(by)));
  }
  return out;
}

/// Ends all lines as Windows does.
inline std::string with_windows_lines(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n' && (i == 0 || text[i - 1] != '\r')) out += '\r';
    out += text[i];
  }
  return out;
}

}  // namespace internal
}  // namespace hypotrack::detail
