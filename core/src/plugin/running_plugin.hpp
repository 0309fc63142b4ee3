#pragma once

#include <optional>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Names the plugin whose code the calling thread runs during this object's lifetime, for the
/// message if the program ends meanwhile. Objects of one thread nest; the newest counts.
class RunningPlugin {
 public:
  /// `who`: place, kind, name and library. `how`: what follows "crashed" in the message. Both must
  /// outlive the object.
  explicit RunningPlugin(const char* who, const char* how = "");
  ~RunningPlugin();
  RunningPlugin(const RunningPlugin&) = delete;
  RunningPlugin& operator=(const RunningPlugin&) = delete;

 private:
  const char* who_;  ///< of the object before
  const char* how_;
};

/// Names the frame that the calling thread works on during this object's lifetime, where that is
/// not the frame that is tracked. Nothing: an unknown frame.
class ThreadFrame {
 public:
  explicit ThreadFrame(std::optional<int> index);
  ~ThreadFrame();
  ThreadFrame(const ThreadFrame&) = delete;
  ThreadFrame& operator=(const ThreadFrame&) = delete;

 private:
  int before_;
};

/// Names the frame that is tracked during this object's lifetime, for the same
/// message. Threads that help the calling one know it too, unless another tracker is at work.
class RunningFrame {
 public:
  explicit RunningFrame(int index);
  ~RunningFrame();
  RunningFrame(const RunningFrame&) = delete;
  RunningFrame& operator=(const RunningFrame&) = delete;

 private:
  ThreadFrame of_thread_;
};

/// Returns the frame that the calling thread works on or, if it named none, that is tracked.
std::optional<int> running_frame();

/// Writes to stderr that the program `ends`, and in which plugin and frame. Allocates nothing, so
/// that signal handlers may call it.
void report_end(const char* ends);

/// Gives the calling thread a second stack for signal handlers, unless it has one: none can run on
/// a stack that is full.
void ensure_signal_stack();

}  // namespace internal
}  // namespace hypotrack::detail
