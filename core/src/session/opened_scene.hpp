#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/term_times.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/source.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "session/scene_file.hpp"
#include "track/loop/scene_tracker.hpp"
#include "track/smooth/fixed_lag_smoother.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// An output and the name of its plugin.
struct NamedOutput {
  std::string name;
  std::unique_ptr<Output> output;
};

/// Everything that a scene file names, made and checked, before the first frame.
struct OpenedScene {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Source> source;
  TrackerParts parts;
  std::unique_ptr<Starter> starter;  ///< null: `parts.starters` look for the models
  InitSettings init;
  OutputSettings output;
  std::vector<NamedTermTimes> term_times;  ///< how long each term has worked so far
  std::vector<NamedOutput> outputs;        ///< of a scene with a source
  std::uint64_t seed = 0;
  ShapeEstimateSettings shape;
  std::shared_ptr<PluginNotes> plugin_notes;  ///< what the plugins tell the user
  std::vector<std::string> notes;             ///< for the user: what was not used, and why
  std::string resolved;         ///< YAML that repeats the run, with the value of every parameter
  std::string source_resolved;  ///< YAML of the source alone, with the value of every parameter
};

/// Opens a scene: models first, then the objective, the optimizer, the judge, the starter and the
/// source. Throws the error of the part that fails.
OpenedScene open_scene(const SceneInput& scene, std::span<const std::string> overrides,
                       PluginLoader& plugins);

/// Opens a scene whose frames come from elsewhere: everything but the source, which the file may
/// leave out. The caller sets `parts.cameras`.
OpenedScene open_without_source(const SceneInput& scene, std::span<const std::string> overrides,
                                PluginLoader& plugins);

/// Opens only the models and the source of a scene, for programs that look at a source (`hypotrack
/// synth`).
OpenedScene open_source(const SceneInput& scene, std::span<const std::string> overrides,
                        PluginLoader& plugins);

/// Opens a scene with a source that another session of the same scene has opened. `source` and
/// `source_resolved` are that session's. It must outlive this one if it made the source.
OpenedScene open_scene(const SceneInput& scene, std::span<const std::string> overrides,
                       PluginLoader& plugins, std::unique_ptr<Source> source,
                       const std::string& source_resolved);

/// Makes the fixed-lag smoother of a session that still has its parts. Returns null if the scene
/// does not ask for it. Throws ConfigError.
std::unique_ptr<FixedLagSmoother> make_fixed_lag_smoother(const OpenedScene& session);

/// Returns the state from which the search of a frame starts: that of the scene's starter, changed
/// as `init` says. Where starters look for the models, it is any state in view. Returns nothing if
/// there is no frame (null) and the starter needs one. `notes`, if given, receives what the starter
/// has to say. Throws ConfigError or DataError, for example if the scene asks for a ground truth
/// that does not exist.
std::optional<Eigen::VectorXd> start_state(const OpenedScene& session, const Frame* frame,
                                           std::vector<std::string>* notes = nullptr);

/// Returns start_state() of the first usable frame of the source.
Eigen::VectorXd initial_state(const OpenedScene& session, const Frame& first,
                              std::vector<std::string>* notes = nullptr);

}  // namespace internal
}  // namespace hypotrack
