#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the path of a program that hypotrack starts by itself, in libexec/hypotrack.
std::filesystem::path libexec_program(const std::string& name);

/// Returns the path of the program that opens plugins in a separate process.
std::filesystem::path probe_program();

/// Returns the folder of the plugins that come with hypotrack.
std::filesystem::path own_plugin_folder();

/// Returns the plugin search path: `extra`, HYPOTRACK_PLUGIN_PATH (absolute folders with colons
/// between them), and the build's own folder. Relative elements of `extra` are relative to the
/// current working directory, because the user typed them. Relative elements in the environment
/// would depend on where the program runs, so they throw PluginError. Empty elements are ignored.
std::vector<std::filesystem::path> plugin_search_path(
    const std::vector<std::filesystem::path>& extra);

}  // namespace internal
}  // namespace hypotrack::detail
