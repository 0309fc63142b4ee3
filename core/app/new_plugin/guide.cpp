#include <filesystem>

#include "base/installation.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "new_plugin/plugin_files.hpp"

namespace hypotrack::app {

std::map<std::string, std::string> files_of_guide(std::string_view markdown) {
  constexpr std::string_view kFence = "```", kFile = " file=";
  std::map<std::string, std::string> out;
  std::string* file = nullptr;
  while (!markdown.empty()) {
    const std::size_t end = markdown.find('\n');
    const std::string_view line = markdown.substr(0, end);
    markdown.remove_prefix(end == std::string_view::npos ? markdown.size() : end + 1);
    if (!line.starts_with(kFence)) {
      if (file) file->append(line).append("\n");
      continue;
    }
    const std::size_t name = line.find(kFile);
    file = file || name == std::string_view::npos
               ? nullptr
               : &out[std::string(line.substr(name + kFile.size()))];
  }
  return out;
}

std::map<std::string, std::string> files_of_guide() {
  const std::filesystem::path file = detail::prefix_folder() / "share/hypotrack/plugin_guide.md";
  const std::string text = read_whole(file).value_or("");
  if (text.empty())
    throw DataError(file.string() + ": cannot be read; it is part of hypotrack, install it again");
  return files_of_guide(text);
}

}  // namespace hypotrack::app
