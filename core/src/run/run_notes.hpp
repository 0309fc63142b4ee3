#pragma once

#include <set>
#include <string>
#include <utility>

#include "hypotrack/session.hpp"
#include "plugin/plugin_notes.hpp"
#include "run/results.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack {

/// Says each fault of a view once.
class FaultNotes {
 public:
  explicit FaultNotes(RunWatcher& watcher) : watcher_(watcher) {}
  void add(const Solution& solution);

 private:
  RunWatcher& watcher_;
  std::set<std::pair<FrameFault, int>> said_;
};

/// Says what plugins tell the user.
class PluginLines {
 public:
  PluginLines(RunWatcher& watcher, PluginNotes& notes) : watcher_(watcher), notes_(notes) {}
  void say_new();
  void say_repeated();

 private:
  RunWatcher& watcher_;
  PluginNotes& notes_;
};

/// Says once that the CPU took the place of a device, whether it failed in tracking or in
/// smoothing.
class DeviceNotes {
 public:
  /// `results` may be null.
  DeviceNotes(RunWatcher& watcher, const SceneTracker& tracker, Results* results)
      : watcher_(watcher), tracker_(tracker), results_(results) {}
  void look(const std::string& where);

 private:
  RunWatcher& watcher_;
  const SceneTracker& tracker_;
  Results* results_;
  bool said_ = false;
};

/// Says once that the outputs take longer than tracking, as on a slow disk.
class OutputNote {
 public:
  /// `results` may be null.
  OutputNote(RunWatcher& watcher, const Results* results) : watcher_(watcher), results_(results) {}
  void look(const ClockTimes& clock);

 private:
  RunWatcher& watcher_;
  const Results* results_;
  bool said_ = false;
};

}  // namespace hypotrack
