#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>

namespace hypotrack {

/// Passes wishes of a viewer to the thread that tracks. All functions may be called from several
/// threads.
class RunControls {
 public:
  void pause();
  void resume();
  /// Lets one frame pass and pauses after it.
  void step();
  void ask_for_restart();
  void ask_for_snapshot();

  bool paused() const;

  // Of the tracking thread.

  /// Waits while the run is paused. Calls `meanwhile` every few milliseconds, which returns false
  /// to end the waiting.
  void wait_while_paused(const std::function<bool()>& meanwhile);
  /// Returns true once after each ask_for_restart().
  bool take_restart();
  bool take_snapshot();

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_ = false;
  int steps_ = 0;
  bool restart_ = false;
  bool snapshot_ = false;
};

}  // namespace hypotrack
