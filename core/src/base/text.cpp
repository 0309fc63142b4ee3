#include "hypotrack/api/text.hpp"

#include <algorithm>

namespace hypotrack {

std::string_view trimmed(std::string_view text, std::string_view blanks) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::string printable(std::string_view text, std::size_t most) {
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  std::size_t size = std::min(text.size(), most);
  while (size > 0 && size < text.size() && continues(text[size])) --size;
  std::string out(text.substr(0, size));
  std::ranges::replace_if(
      out, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return size < text.size() ? out + "..." : out;
}

}  // namespace hypotrack
