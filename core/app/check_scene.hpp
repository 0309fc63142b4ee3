#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "hypotrack/plugin.hpp"

namespace hypotrack::app {

/// What is known of a scene after it was opened and its first frame was looked at.
struct CheckedScene {
  std::size_t models = 0;
  std::size_t cameras = 0;
  int parameters = 0;
  std::optional<int> frames;
  std::string backend;
  std::string problem;   ///< of the first frame; empty if it can be used
  std::string resolved;  ///< YAML with every parameter
};

/// Opens everything that a run would open and checks the first frame. Prints notes on what looks
/// mistaken. Draws the start on the first usable frame if `draw` names a picture to write. Throws
/// the error of the part that fails.
CheckedScene check_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                         PluginLoader& plugins,
                         const std::optional<std::filesystem::path>& draw = std::nullopt);

}  // namespace hypotrack::app
