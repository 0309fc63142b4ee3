#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::app {

/// Which plugin is to be written.
struct PluginRequest {
  std::string kind;   ///< of the table in hypotrack/plugin/plugin.hpp
  std::string name;   ///< in scenes; its source file and class are named after it
  bool cuda = false;  ///< with a part for GPUs
};

/// Returns the kinds of which plugins can be written.
std::vector<std::string> plugin_kinds();

/// Returns the files of a plugin's project by name: sources, CMakeLists.txt, scene.yaml. `guide`:
/// files_of_guide(). Throws ConfigError for a name that C++ does not allow, an unknown kind, and a
/// GPU part of a kind that has none.
std::map<std::string, std::string> plugin_files(const PluginRequest& request,
                                                const std::map<std::string, std::string>& guide);

/// Returns a scene of a moving box that the synthetic source renders.
std::string rendered_scene();

/// Renders the frames of a scene into a new folder, in the layout of the EuRoC MAV dataset, which
/// the example of a source reads. Throws what sources throw, and OutputError.
void write_example_recording(const std::filesystem::path& scene, PluginLoader& plugins,
                             const std::filesystem::path& folder);

/// Returns the files that a guide for authors shows, by name: its blocks ```` ```lang file=NAME
/// ````.
std::map<std::string, std::string> files_of_guide(std::string_view markdown);

/// Reads those of the installed guide. Throws DataError if there is none.
std::map<std::string, std::string> files_of_guide();

}  // namespace hypotrack::app
