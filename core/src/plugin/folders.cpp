#include "plugin/folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "base/installation.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

constexpr const char* kPluginPathVariable = "HYPOTRACK_PLUGIN_PATH";

void add_once(std::vector<std::filesystem::path>& folders, std::filesystem::path folder) {
  folder = folder.lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // a trailing slash
  if (std::find(folders.begin(), folders.end(), folder) == folders.end()) {
    folders.push_back(std::move(folder));
  }
}

void add_from_environment(std::vector<std::filesystem::path>& folders) {
  const char* value = std::getenv(kPluginPathVariable);
  std::string_view rest = value ? value : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::filesystem::path folder(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (folder.empty()) continue;
    if (folder.is_relative()) {
      throw PluginError(fmt::format(
          "{}: '{}' is a relative path, so that what is loaded would depend on the working "
          "directory; expected absolute folders with ':' between them",
          kPluginPathVariable, folder.string()));
    }
    add_once(folders, folder);
  }
}

}  // namespace

std::filesystem::path libexec_program(const std::string& name) {
  return prefix_folder() / HYPOTRACK_PROBE_DIR / name;
}

std::filesystem::path probe_program() { return libexec_program("hypotrack_plugin_probe"); }

std::filesystem::path own_plugin_folder() { return prefix_folder() / HYPOTRACK_PLUGIN_DIR; }

std::vector<std::filesystem::path> plugin_search_path(
    const std::vector<std::filesystem::path>& extra) {
  std::vector<std::filesystem::path> folders;
  for (const auto& folder : extra) {
    if (!folder.empty()) add_once(folders, std::filesystem::absolute(folder));
  }
  add_from_environment(folders);
  add_once(folders, own_plugin_folder());
  return folders;
}

}  // namespace hypotrack::detail::internal
