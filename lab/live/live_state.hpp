#pragma once

#include <chrono>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "lab/json_file.hpp"
#include "viewing/latest.hpp"
#include "viewing/live_frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What the page shows as numbers: the newest solution and the last minutes, as JSON. All functions
/// may be called from several threads.
class LiveState {
 public:
  LiveState() { publish(); }

  /// Sets the scene's models. `frames`: number of frames of the run, if known.
  void begin(const Scene& scene, std::optional<int> frames);
  void add(const Scene& scene, const LiveFrame& frame);
  void set_paused(bool paused);
  /// Shows a line of text.
  void say(const std::string& text);
  /// Publishes that the run has ended; nothing more comes.
  void end();

  /// Returns the states as one line of JSON each: run, frame, time, status, fps, milliseconds,
  /// error_mm, text and models; by model name, status, probability, sigma_mm and motion. `run` is
  /// waits, runs, paused or ended. Unknown numbers are null.
  const Latest<std::string>& states() const { return states_; }

  /// Returns the solutions as solution_json() writes them.
  const Latest<std::string>& solutions() const { return solutions_; }

  /// Returns number of frames and models: name, shape (replay_shape()), motion at rest. It has no
  /// models before begin().
  std::string scene_json() const;
  /// Returns numbers of the last minutes: a list of samples with seconds, milliseconds, error_mm
  /// and by model probability and sigma_mm.
  std::string history_json() const;

 private:
  using Clock = std::chrono::steady_clock;

  void publish();

  mutable std::mutex mutex_;
  Json scene_ = Json::object();
  Json newest_ = Json::object();
  std::deque<Json> history_;
  Clock::time_point sampled_;
  Clock::time_point begun_ = Clock::now();
  bool runs_ = false, paused_ = false, ended_ = false;
  std::string text_;
  Latest<std::string> states_, solutions_;
};

}  // namespace internal
}  // namespace hypotrack
