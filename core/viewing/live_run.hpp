#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/output.hpp"
#include "run/run_scene.hpp"
#include "viewing/frame_rate.hpp"
#include "viewing/recorder.hpp"
#include "viewing/run_controls.hpp"
#include "viewing/viewer.hpp"

namespace hypotrack {

/// Shows a run to any number of viewers and carries out their requests. Without viewers it does
/// nothing. Functions are called from the thread that tracks.
class LiveRun {
 public:
  /// `folder`: that of the results. `tell` receives lines for the user, as the viewers do.
  LiveRun(std::filesystem::path folder, std::function<void(const std::string&)> tell);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Returns what viewers steer the run with.
  RunControls& controls() { return controls_; }
  /// Adds a viewer before the run is opened.
  void add(std::unique_ptr<Viewer> viewer) { viewers_.push_back(std::move(viewer)); }
  /// Returns what connects the run with the viewers. The object must outlive the run.
  RunAdditions additions();

  /// Waits while a viewer pauses the run, or until `interrupted` returns true. Returns whether a
  /// viewer wants the run to end.
  bool wait_while_paused(const std::function<bool()>& interrupted);
  // As those of RunWatcher.
  void begin(std::optional<int> frames);
  void frame(const Frame& frame, const Solution& solution, double error);
  void end();

 private:
  class SnapshotOutput;
  void open(OutputContext& run);
  void close();
  void do_what_is_asked();
  void write_snapshot();
  void set_status();
  void say(const std::string& text);
  template <class Function>
  void show(const Function& function);

  RunControls controls_;
  std::function<void(const std::string&)> tell_;
  std::filesystem::path place_;       ///< name of the folder of the results
  std::optional<OpenFolder> folder_;  ///< the same, while there is a run
  Recorder recorder_;
  OutputContext* run_ = nullptr;        ///< while there is one
  std::unique_ptr<Renderer> renderer_;  ///< of snapshots; the run's draws in another thread
  std::shared_ptr<const ShownViews> shown_;
  FrameRate rate_;
  LiveStatus status_;
  bool tracking_ = false;       ///< between begin() and end()
  bool told_of_error_ = false;  ///< of a viewer
  std::vector<std::unique_ptr<Viewer>> viewers_;
};

}  // namespace hypotrack
