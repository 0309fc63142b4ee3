#include "base/installation.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::detail::internal {

std::filesystem::path prefix_folder() {
  static const std::filesystem::path prefix = [] {
    Dl_info info{};
    if (!dladdr(reinterpret_cast<const void*>(&prefix_folder), &info) || !info.dli_fname) {
      throw PluginError("cannot find out where libhypotrack.so lies; set HYPOTRACK_PLUGIN_PATH");
    }
    std::filesystem::path folder = std::filesystem::canonical(info.dli_fname).parent_path();
    for ([[maybe_unused]] const auto& part : std::filesystem::path(HYPOTRACK_LIBDIR)) {
      folder = folder.parent_path();
    }
    return folder;
  }();
  return prefix;
}

}  // namespace hypotrack::detail::internal

namespace hypotrack {

std::filesystem::path data_file(const std::filesystem::path& relative) {
  constexpr const char* kDataPathVariable = "HYPOTRACK_DATA_PATH";
  const char* variable = std::getenv(kDataPathVariable);
  const bool chosen = variable && *variable;
  const std::filesystem::path folder =
      chosen ? std::filesystem::absolute(variable) : detail::prefix_folder() / HYPOTRACK_DATA_DIR;
  const std::filesystem::path file = (folder / relative).lexically_normal();
  if (std::filesystem::exists(file)) return file;
  throw DataError(fmt::format(
      "{}: there is no such file; it comes with hypotrack. {}", file.string(),
      chosen ? fmt::format("{} says to look there", kDataPathVariable)
             : fmt::format("Build or install hypotrack completely, or set {} to the folder that "
                           "holds '{}'",
                           kDataPathVariable, relative.string())));
}

}  // namespace hypotrack
