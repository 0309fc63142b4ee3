#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "base/exported.hpp"
#include "hypotrack/api/session.hpp"
#include "plugin/plugin_notes.hpp"
#include "run/results.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Says what a run's user should know while it goes on, each thing once.
class RunNotes {
 public:
  /// `given_start`: whether the scene gives a start. `results` may be null. All must outlive it.
  RunNotes(RunWatcher& watcher, SceneTracker& tracker, bool given_start, PluginNotes& plugins,
           Results* results)
      : watcher_(watcher),
        tracker_(tracker),
        plugins_(plugins),
        results_(results),
        start_said_(!given_start) {}

  /// Says that the run shares its GPU with another program.
  void look_at_gpu();
  /// Looks at a frame that was tracked and whose results were added.
  void add(const Solution& solution, const ClockTimes& clock);
  /// Looks for a device that failed; `where`: `frame 12`.
  void look_at_device(const std::string& where);
  /// Says what plugins told since the last call.
  void say_plugin_lines();
  /// Says that too, and how often plugins repeated it.
  void finish();

 private:
  void add_fault(const Solution& solution);
  void say_rig_notes();
  void look_at_start(const Solution& solution);
  void look_at_outputs(const ClockTimes& clock);

  RunWatcher& watcher_;
  SceneTracker& tracker_;
  PluginNotes& plugins_;
  Results* results_;
  std::set<std::pair<FrameFault, int>> faults_said_;
  bool start_said_, device_said_ = false, outputs_said_ = false;
};

}  // namespace internal
}  // namespace hypotrack
