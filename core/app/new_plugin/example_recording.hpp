#pragma once

#include <filesystem>

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::app {

/// Renders the frames of a scene into a new folder, in the layout of the EuRoC MAV dataset, which
/// the example of a source reads. Throws what sources throw, and OutputError.
void write_example_recording(const std::filesystem::path& scene, PluginLoader& plugins,
                             const std::filesystem::path& folder);

}  // namespace hypotrack::app
