#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>

namespace hypotrack {

/// Passes wishes of viewers to the thread that tracks. All functions may be called from several
/// threads.
class RunControls {
 public:
  void pause();
  void resume();
  /// Pauses, or goes on after a pause.
  void toggle_pause();
  /// Lets one frame pass and pauses after it.
  void step();
  void ask_for_restart();
  void ask_for_snapshot();
  /// Starts a recording of the source's frames, or ends it.
  void toggle_recording();
  /// Ends the run before the next frame, for good.
  void ask_for_end();

  bool paused() const;
  bool recording_wanted() const;
  bool end_wanted() const;

  // Of the tracking thread.

  /// Waits while the run is paused and its end is not wanted. Calls `meanwhile` every few
  /// milliseconds, which returns false to end the waiting.
  void wait_while_paused(const std::function<bool()>& meanwhile);
  /// Returns true once after each ask_for_restart().
  bool take_restart();
  bool take_snapshot();
  /// Takes the wish for a recording back, where there cannot be one.
  void cancel_recording();

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_ = false;
  int steps_ = 0;
  bool restart_ = false;
  bool snapshot_ = false;
  bool recording_ = false;
  bool end_ = false;
};

}  // namespace hypotrack
