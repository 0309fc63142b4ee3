#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin.hpp"

namespace hypotrack::detail {

/// Kind and name that a library's file name promises: libhypotrack_<kind>_<name>.so.
struct PluginId {
  std::string kind;
  std::string name;
};

inline constexpr std::string_view kPluginKinds[] = {"model", "objective", "optimizer", "source"};

std::string library_file_name(std::string_view kind, std::string_view name);

/// Nothing if the file is not called like a plugin library.
std::optional<PluginId> id_from_file_name(const std::filesystem::path& file);

/// Whether a text can name a plugin: [a-z0-9_]+.
bool is_plugin_name(std::string_view name);

/// Names of the plugins of a kind whose libraries lie on the search path, sorted.
std::vector<std::string> plugin_names(std::string_view kind,
                                      std::span<const std::filesystem::path> search_path);

/// Opens a library for good. Throws PluginError without naming the file.
void* load_library(const std::filesystem::path& file);

/// What an opened library says it is; nothing in it has been compared yet. Throws PluginError
/// without naming the file.
const HypotrackPlugin& descriptor_of(void* library);

/// What keeps a plugin from being used by this hypotrack, with both sides of the mismatch; empty if
/// nothing does. Reads no member before those that say whether it is there.
std::string find_mismatch(const HypotrackPlugin& plugin, const PluginId& expected);

}  // namespace hypotrack::detail
