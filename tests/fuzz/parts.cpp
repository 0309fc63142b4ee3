#include "parts.hpp"

#include <algorithm>

namespace hypotrack::fuzz {

void write_parts(std::string_view bytes, const std::filesystem::path& folder,
                 std::span<const std::string_view> known) {
  constexpr std::string_view kBegin = "=== ";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  while (bytes.starts_with(kBegin)) {
    bytes.remove_prefix(kBegin.size());
    const std::size_t line = std::min(bytes.find('\n'), bytes.size());
    const std::string_view name = bytes.substr(0, line);
    bytes.remove_prefix(std::min(line + 1, bytes.size()));
    const std::string_view content = bytes.substr(0, bytes.find(kBegin));
    bytes.remove_prefix(content.size());
    if (std::ranges::find(known, name) != known.end()) scratch_file(folder / name, content);
  }
}

}  // namespace hypotrack::fuzz
