#include "run/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/cuda/backend_text.hpp"
#include "cost/cuda/device.hpp"
#include "track/faults/picture_checks.hpp"

namespace hypotrack::internal {

void RunNotes::add(const Solution& solution, const ClockTimes& clock) {
  add_fault(solution);
  look_at_start(solution);
  say_rig_notes();
  look_at_device(fmt::format("frame {}", solution.frame));
  say_plugin_lines();
  look_at_outputs(clock);
}

void RunNotes::look_at_gpu() {
  const auto gpu = cuda::gpu_in(tracker_.backend());
  if (!gpu || cuda::claim_gpu(*gpu)) return;
  watcher_.say(
      fmt::format("note: another hypotrack uses GPU {}; programs take turns on it, which makes "
                  "both slow. `hypotrack "
                  "run SCENE... --jobs N` tracks several scenes in one program",
                  *gpu));
}

void RunNotes::add_fault(const Solution& solution) {
  const auto& [fault, view] = std::pair(solution.fault, solution.fault_view);
  if (fault != FrameFault::none && faults_said_.emplace(fault, view).second)
    watcher_.say(fmt::format("note: frame {}: {}", solution.frame, describe(fault, view)));
}

void RunNotes::say_rig_notes() {
  for (const std::string& note : tracker_.take_rig_notes()) watcher_.say("note: " + note);
}

/// Says if detectors or pictures contradict what is found from a start that was given.
void RunNotes::look_at_start(const Solution& solution) {
  for (const std::string& note : tracker_.take_start_notes()) {
    watcher_.say("note: " + note);
    start_said_ = true;
  }
  if (solution.status == Status::missing || std::exchange(start_said_, true)) return;
  for (std::size_t m = 0; m < solution.models.size(); ++m) {
    const double probability = solution.probabilities[m];
    if (solution.models[m] != Status::lost || std::isnan(probability)) continue;
    watcher_.say(fmt::format(
        "note: frame {}: judged by the pictures, the pose found from the start is wrong "
        "(probability {:.2f} that it is right). Is the start (init) where the models are? If so, "
        "the judge may not suit them: take another, or `judge: none`",
        solution.frame, probability));
    return;
  }
}

/// Says that the CPU took the place of a device, whether it failed in tracking or in smoothing.
void RunNotes::look_at_device(const std::string& where) {
  std::string error = tracker_.device_error();
  if (error.empty() && results_) error = results_->device_error();
  if (error.empty() || std::exchange(device_said_, true)) return;
  watcher_.say(fmt::format("note: {}: {}; the run goes on with the CPU", where, error));
  if (results_) results_->add_device_error(error);
}

/// Says that the outputs take longer than tracking, as on a slow disk.
void RunNotes::look_at_outputs(const ClockTimes& clock) {
  constexpr double kLeast = 2;  // seconds, for what begins slowly
  const double writing = results_ ? results_->writing_seconds() : 0;
  if (writing < std::max(kLeast, clock.tracking) || std::exchange(outputs_said_, true)) return;
  watcher_.say(fmt::format(
      "note: outputs have taken {:.1f} s so far, and tracking {:.1f} s; is the disk of {} slow? "
      "The run is faster with another folder or with fewer outputs",
      writing, clock.tracking, results_->folder().string()));
}

void RunNotes::say_plugin_lines() {
  for (const std::string& line : plugins_.take_lines()) watcher_.say(line);
}

void RunNotes::finish() {
  say_plugin_lines();
  for (const std::string& line : plugins_.repeated_lines()) watcher_.say(line);
}

}  // namespace hypotrack::internal
