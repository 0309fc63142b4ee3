#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// What is known about one plugin library. Where `problem` is not empty, only the path and what the
/// file name says are.
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

/// How long a library may take to load and describe itself.
inline constexpr std::chrono::milliseconds kInspectTime{10'000};

/// Opens a library in a child process and reports on it. Whatever it does there (crash, hang, exit)
/// ends in `problem`: "crashed: SIGSEGV while loading". The child is a fresh program, so that this
/// is safe however many threads are running. Throws PluginError if that program is not installed.
HYPOTRACK_API PluginRow check_plugin(const std::filesystem::path& file,
                                     std::chrono::milliseconds limit = kInspectTime);

/// Every plugin library on a search path, by kind and name. One that another folder hides is listed
/// with that as its problem.
HYPOTRACK_API std::vector<PluginRow> list_plugins(
    std::span<const std::filesystem::path> search_path,
    std::chrono::milliseconds limit = kInspectTime);

/// The plugins that `what` means: a kind (`optimizer`), a name (`pso`) or both (`optimizer/pso`).
/// Throws PluginError, with the nearest name, if there are none.
HYPOTRACK_API std::vector<PluginRow> find_plugins(
    std::span<const std::filesystem::path> search_path, std::string_view what,
    std::chrono::milliseconds limit = kInspectTime);

/// One line per plugin: kind, name, version, licence, and summary or problem.
HYPOTRACK_API std::string format_table(std::span<const PluginRow> rows);

/// Everything about one plugin, its parameters last.
HYPOTRACK_API std::string format_info(const PluginRow& row);

/// "FILE: optimizer 'pso' 0.1.0 can be used", or why it cannot.
HYPOTRACK_API std::string format_check(const PluginRow& row);

}  // namespace hypotrack
