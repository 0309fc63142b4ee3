#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/frame_cost.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "hypotrack/api/program_plugin.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/api/stop.hpp"
#include "hypotrack/api/tracker.hpp"
#include "hypotrack/plugin/source.hpp"

namespace hypotrack {

/// Changes to a scene, where its plugins are, and what the program adds.
struct SessionOptions {
  std::vector<std::string> set = {};                    ///< overrides: `key.path=value`
  std::vector<std::filesystem::path> plugin_path = {};  ///< folders to search before the usual ones
  std::vector<ProgramPlugin> plugins = {};              ///< before all libraries
  std::map<std::string, MeshArrays> meshes = {};        ///< by NAME: `mesh: attached:NAME`
};

/// Extent and results of a run.
struct RunOptions {
  std::filesystem::path out = {};  ///< folder for tables, video, summary; empty: none are written
  std::optional<int> frames = {};  ///< stop after this many
  /// Ends the run in the middle of a frame, within about 0.2 s. That frame is not written, those
  /// before are.
  StopTest stop_now = {};
};

/// Follows a run and may stop it. Every function may be left as it is.
class HYPOTRACK_API RunWatcher {
 public:
  virtual ~RunWatcher();

  /// Returns true to end the run before the next frame. Is also asked while a shape is fitted. A
  /// run that was stopped stays stopped.
  virtual bool stop() { return false; }
  /// Receives a line for the user: the backend, a likely mistake in the scene, where files are.
  virtual void say(const std::string& text);
  /// Is called before the first frame, with the number of frames if it is known.
  virtual void begin(std::optional<int> frames);
  /// Receives every frame with its solution, before fixed-lag smoothing. `error`: mean distance of
  /// the landmarks from the ground truth, in metres; NaN: unknown, or smoothing is still to come.
  virtual void frame(const Frame& frame, const Solution& solution, double error);
  /// Is called after the last frame, also when an error ends the run. Must not throw.
  virtual void end() {}
};

/// A scene, opened: models, objective and optimizer are made and checked.
///
///   hypotrack::Session session("scene.yaml");
///   hypotrack::Tracker tracker = session.tracker(cameras);  // load_calibration() reads them
///   hypotrack::Solution solution = tracker.track(frame);
class HYPOTRACK_API Session {
 public:
  /// Opens a scene. Its source is opened by run() only, and may be left out of the file by programs
  /// that have frames of their own. Throws ConfigError, PluginError, DataError or DeviceError.
  explicit Session(const std::filesystem::path& scene, SessionOptions options = {});
  /// Opens a scene that a program made: ConfigValue::document(), or ConfigNode::parse() of YAML.
  /// All else is as with a file. Messages have the document's name and the key path.
  explicit Session(ConfigNode scene, SessionOptions options = {});
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  const Scene& scene() const;

  /// Makes a tracker for frames from these cameras; the first is "left". A camera without a size
  /// gets that of its first image. The tracker is independent of the session. Throws DataError on
  /// invalid cameras. Throws ConfigError if the scene cannot be tracked with them, or has
  /// `shape.estimate_s`, which needs a source.
  Tracker tracker(std::vector<Camera> cameras);

  /// Makes the cost of states in frames from these cameras, which need sizes. It is independent of
  /// the session. Throws DataError on invalid cameras, ConfigError or DeviceError.
  FrameCost frame_cost(std::vector<Camera> cameras);

  /// Opens the scene's own source, for programs that want its frames alone. It is independent of
  /// the session. Throws ConfigError if the scene names none, and the errors of models and source.
  std::unique_ptr<Source> source();

  /// Tracks the frames of the scene's own source. Returns false if the watcher or
  /// RunOptions::stop_now ended the run.
  /// Results of the frames so far are kept if an error ends it. Throws ConfigError if the scene
  /// names no source, and the errors of its parts.
  bool run(const RunOptions& options, RunWatcher& watcher);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
