#include <fmt/format.h>

#include <system_error>

#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"
#include "output/recording/recording_folder.hpp"

namespace hypotrack::internal {
namespace {

/// Copies a file; returns the copy's name, or the absolute path of a file that does not exist.
std::string copied(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return std::filesystem::absolute(file).lexically_normal().string();
  const std::string name = "start_" + file.filename().string();
  std::filesystem::copy_file(file, folder / name, std::filesystem::copy_options::overwrite_existing,
                             error);
  if (error)
    throw OutputError(fmt::format("{}: the start's file cannot be copied to {}: {}", file.string(),
                                  (folder / name).string(), error.message()));
  return name;
}

/// Returns a start, {type, file, ...}, with its file copied.
detail::YamlDocument with_copy(const ConfigNode& start, const std::filesystem::path& folder) {
  detail::YamlDocument out(start.to_yaml());
  const ConfigNode file = start.get("file");
  if (file.is_scalar() && !file.is_null())
    out.set_string("file", copied(file.directory() / file.scalar(), folder));
  return out;
}

}  // namespace

std::string copy_start_files(const InitSettings& init, const std::filesystem::path& folder) {
  detail::YamlDocument out(dump_params(init));
  if (!init.file.empty()) out.set_string("file", copied(init.file, folder));
  if (init.from.is_map()) out.set("from", with_copy(init.from, folder));
  return out.text();
}

}  // namespace hypotrack::internal
