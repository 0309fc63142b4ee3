#pragma once

namespace hypotrack::detail {

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

/// Names the frame that is tracked during this object's lifetime, for the same message.
class RunningFrame {
 public:
  explicit RunningFrame(int index);
  ~RunningFrame();
  RunningFrame(const RunningFrame&) = delete;
  RunningFrame& operator=(const RunningFrame&) = delete;
};

/// Writes to stderr that the program `ends`, and in which plugin and frame. Allocates nothing, so
/// that signal handlers may call it.
void report_end(const char* ends);

}  // namespace hypotrack::detail
