#include <optional>
#include <set>
#include <string>

#include "camera/pair_check.hpp"
#include "check_scene.hpp"
#include "messages.hpp"
#include "track/faults/picture_checks.hpp"

namespace hypotrack::app {

void tell_notes(const Source& source, const SceneTracker& tracker, const Frame& first) {
  for (const std::string& note : source.notes()) tell("note: {}\n", note);
  for (const std::string& problem :
       {problem_of_pair(source.cameras()), tracker.problem_of_start(first)})
    if (!problem.empty()) tell("note: {}\n", problem);
}

void tell_faults(Source& source, SceneTracker& tracker, const Frame& first) {
  constexpr int kFrames = 3;
  std::set<FrameFault> told;
  std::optional<Frame> frame = first;
  for (int i = 0; i < kFrames && frame; frame = source.next(), ++i) {
    if (frame->views.empty()) continue;
    const auto [fault, view] = tracker.fault_of(*frame);
    if (fault != FrameFault::none && told.insert(fault).second)
      tell("note: frame {}: {}\n", frame->index, describe(fault, view));
  }
  for (const std::string& note : tracker.take_rig_notes()) tell("note: {}\n", note);
}

}  // namespace hypotrack::app
