#pragma once

#include <map>
#include <string>
#include <vector>

namespace hypotrack::app {

/// Which plugin is to be written.
struct PluginRequest {
  std::string kind;  ///< objective, optimizer, model, source, start or output
  std::string
      name;  ///< of the plugin in scenes, of its source file and in another form of its class
  bool cuda = false;  ///< with a part for GPUs
};

/// Returns the kinds of which plugins can be written.
std::vector<std::string> plugin_kinds();

/// Returns the files of a project for a plugin, by name: its sources, CMakeLists.txt and
/// scene.yaml. `guide`: files_of_guide(). Throws ConfigError for a name that cannot be one of C++,
/// or a GPU part of what has none.
std::map<std::string, std::string> plugin_files(const PluginRequest& request,
                                                const std::map<std::string, std::string>& guide);

/// Returns a scene of the kind's example with the synthetic source, whatever the request.
std::string rendered_scene();

}  // namespace hypotrack::app
