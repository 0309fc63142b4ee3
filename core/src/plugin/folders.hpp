#pragma once

#include <filesystem>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// The folder that holds lib/, share/ and so on: of the installation or the build tree that this
/// libhypotrack.so was loaded from.
std::filesystem::path prefix_folder();

/// The program that opens plugins in a process of their own.
std::filesystem::path probe_program();

/// `extra`, HYPOTRACK_PLUGIN_PATH (absolute folders with colons between them), the build's own
/// folder. Relative elements of `extra` are relative to the working directory as it is now, for
/// they were typed on purpose; in the environment they would depend on where one happens to be, and
/// throw PluginError. Empty elements are ignored.
HYPOTRACK_API std::vector<std::filesystem::path> plugin_search_path(
    const std::vector<std::filesystem::path>& extra);

}  // namespace hypotrack::detail
