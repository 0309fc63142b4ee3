#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A plugin library's description. If `problem` is not empty, only the path and what the file name
/// tells are set.
struct PluginRow {
  std::filesystem::path path;
  std::string kind;
  std::string name;
  std::string version;
  std::string summary;
  std::string licence;
  std::string capabilities;  ///< space-separated
  std::string parameters;    ///< describe_params() of the plugin
  std::string problem;       ///< why it cannot be used

  bool usable() const { return problem.empty(); }
};

/// Time limit for a library to load and describe itself.
inline constexpr std::chrono::milliseconds kInspectTime{10'000};

/// Opens a library in a child process and describes it. A crash, hang or exit there becomes a
/// `problem`: "crashed: SIGSEGV while loading". The child is a new program, so this is safe with
/// any number of threads. Throws PluginError if that program is not installed.
PluginRow check_plugin(const std::filesystem::path& file,
                       std::chrono::milliseconds limit = kInspectTime);

/// Lists every plugin library on a search path, sorted by kind and name. A library that an earlier
/// folder hides has that as its problem.
std::vector<PluginRow> list_plugins(std::span<const std::filesystem::path> search_path,
                                    std::chrono::milliseconds limit = kInspectTime);

/// Finds plugins by kind (`optimizer`), name (`pso`) or both (`optimizer/pso`). Throws PluginError,
/// with the nearest name, if there are none.
std::vector<PluginRow> find_plugins(std::span<const std::filesystem::path> search_path,
                                    std::string_view what,
                                    std::chrono::milliseconds limit = kInspectTime);

/// Formats one line per plugin: kind, name, version, licence, and summary or problem.
std::string format_table(std::span<const PluginRow> rows);

/// Formats everything about one plugin, its parameters last.
std::string format_info(const PluginRow& row);

/// Returns a page of the documentation: summary, capabilities and a table of the parameters. Leaves
/// out what depends on the build.
std::string format_markdown(const PluginRow& row);

/// Formats "FILE: optimizer 'pso' 0.1.0 can be used", and for which hypotrack it was built; or why
/// it cannot.
std::string format_check(const PluginRow& row);

}  // namespace internal
}  // namespace hypotrack
