#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/kept_results.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/source.hpp"
#include "track/loop/scene_tracker.hpp"

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

/// First frames of sources, by their YAML and that of their models: those of a study's cells are
/// mostly the same.
using FirstFrames = KeptResults<std::string, std::shared_ptr<const Frame>>;

/// Opens everything that a run would open and checks the first frame. Prints notes on what looks
/// mistaken. Takes the frame from `first_frames` if given. Draws the start on the first usable
/// frame if `draw` names a picture to write. Throws the error of the part that fails.
CheckedScene check_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                         PluginLoader& plugins,
                         const std::optional<std::filesystem::path>& draw = std::nullopt,
                         FirstFrames* first_frames = nullptr);

/// Prints notes on a scene that has no error but looks mistaken in its first usable frame.
void tell_notes(const Source& source, const SceneTracker& tracker, const Frame& first);

/// Prints what is wrong with the pictures or times of the first frames. `first` was read already;
/// the next ones are read from the source.
void tell_faults(Source& source, SceneTracker& tracker, const Frame& first);

}  // namespace hypotrack::app
