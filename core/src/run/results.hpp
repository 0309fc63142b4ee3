#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/exported.hpp"
#include "hypotrack/api/session.hpp"
#include "output/run/fixed_lag_output.hpp"
#include "output/run/output_queue.hpp"
#include "output/run/run_output.hpp"
#include "session/opened_scene.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Results of a run in a folder.
class Results {
 public:
  /// Takes the outputs of the scene, which must outlive it.
  Results(OpenedScene& scene, std::unique_ptr<FixedLagSmoother> smoother,
          const std::string& backend, const std::filesystem::path& folder, RunWatcher& watcher);

  /// Returns true if an output draws the search of this frame.
  bool want_search(const Frame& frame) const { return output_.want_search(frame); }
  void add_search(const Frame& frame, const Solution& solution, SearchRecord record) {
    queue_.add_search(frame, solution, std::move(record));
  }
  void add_trace(int frame, const FrameTrace& trace) { queue_.add_trace(frame, trace); }
  void add(const SceneTracker& tracker, const Frame& frame, const Solution& solution) {
    frames_.add(tracker, frame, solution);
  }

  /// Smooths and writes the frames that still wait.
  void settle() {
    frames_.finish();
    queue_.settle();
  }

  /// Returns the error after which smoothing left a device; empty: there was none.
  std::string device_error() const { return frames_.device_error(); }
  /// Notes for the summary that the CPU took the place of a device.
  void add_device_error(const std::string& error);

  /// Returns true if the run writes how searches converge.
  bool traces() const { return traces_; }
  /// Returns true if frames are smoothed before they are written.
  bool smooths() const { return smooths_; }
  /// Returns the name that the folder has now.
  std::filesystem::path folder() const { return output_.folder().place(); }
  /// Returns how long the outputs have worked, in seconds.
  double writing_seconds() const { return queue_.seconds(); }

  /// Closes the files. Returns nothing if there is no frame.
  std::optional<Summary> finish(bool complete, const ClockTimes& clock);

  /// Says where the files with the frames so far are.
  void tell_of_frames();

  /// Keeps the frames tracked so far after an exception, which is being handled.
  void finish_after_error(const ClockTimes& clock);

 private:
  RunWatcher& watcher_;
  std::string backend_;
  bool smooths_;
  bool traces_;
  RunOutput output_;
  OutputQueue queue_;
  FixedLagOutput frames_;
};

}  // namespace internal
}  // namespace hypotrack
