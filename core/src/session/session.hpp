#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/source.hpp"
#include "session/scene_file.hpp"
#include "track/smooth/hindsight.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// Everything that a scene file names, made and checked, before the first frame.
struct Session {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Source> source;
  TrackerParts parts;
  InitSettings init;
  OutputSettings output;
  std::uint64_t seed = 0;
  ShapeEstimateSettings shape;
  std::string resolved;         ///< YAML that repeats the run: every parameter with its value
  std::string source_resolved;  ///< the same of the source alone
};

/// Opens a scene: models first, then the source, the objective and the optimizer. Throws what is
/// wrong with any of them.
HYPOTRACK_API Session open_session(const std::filesystem::path& scene_file,
                                   std::span<const std::string> overrides, PluginLoader& plugins);

/// Models and source only, for programs that look at a source (`hypotrack synth`).
HYPOTRACK_API Session open_source(const std::filesystem::path& scene_file,
                                  std::span<const std::string> overrides, PluginLoader& plugins);

/// A scene whose source is open already: that of another session of it (which must outlive this one
/// if it made the source), as its `source` and `source_resolved`.
HYPOTRACK_API Session open_session(const std::filesystem::path& scene_file,
                                   std::span<const std::string> overrides, PluginLoader& plugins,
                                   std::unique_ptr<Source> source,
                                   const std::string& source_resolved);

/// Hindsight of a session that still has its parts; null where the scene does not ask for it.
/// Throws ConfigError.
HYPOTRACK_API std::unique_ptr<Hindsight> make_hindsight(const Session& session);

/// The state that the first search starts from. `first` is the first usable frame of the source.
/// Throws ConfigError if the scene asks for a ground truth that is not there.
HYPOTRACK_API Eigen::VectorXd initial_state(const Session& session, const Frame& first);

}  // namespace hypotrack
