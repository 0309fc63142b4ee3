#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "output/run/summary.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How a run ended.
struct RunResult {
  bool complete = false;           ///< false if the watcher ended it
  std::optional<Summary> summary;  ///< nothing if no files were written
  std::filesystem::path folder;    ///< of the files: another than wanted if it was renamed
};

/// What a program adds to a run. Everything may be left as it is.
struct RunAdditions {
  std::vector<NamedOutput> outputs = {};  ///< after the scene's
  std::function<bool()> searches_anew =
      nullptr;  ///< returns true before a frame to forget the models
  /// Receives the scene before the outputs begin. It lives until they are destroyed.
  std::function<void(const OpenedScene&)> opened = nullptr;
};

/// Opens a scene, tracks the frames of its source and writes the results. Estimates the shape from
/// the first seconds before that, if the scene asks for it. After an error the results of the
/// frames so far are kept, and the error is thrown.
RunResult run_scene(const SceneInput& scene, std::span<const std::string> overrides,
                    PluginLoader& plugins, const RunOptions& options, RunWatcher& watcher,
                    RunAdditions additions = {});

}  // namespace internal
}  // namespace hypotrack
