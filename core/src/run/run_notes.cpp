#include "run/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "track/faults/fault_text.hpp"

namespace hypotrack {

void FaultNotes::add(const Solution& solution) {
  const auto& [fault, view] = std::pair(solution.fault, solution.fault_view);
  if (fault != FrameFault::none && said_.emplace(fault, view).second)
    watcher_.say(fmt::format("note: frame {}: {}", solution.frame, describe(fault, view)));
}

void PluginLines::say_new() {
  for (const std::string& line : notes_.take_lines()) watcher_.say(line);
}

void PluginLines::say_repeated() {
  say_new();
  for (const std::string& line : notes_.repeated_lines()) watcher_.say(line);
}

void DeviceNotes::look(const std::string& where) {
  std::string error = tracker_.device_error();
  if (error.empty() && results_) error = results_->device_error();
  if (error.empty() || std::exchange(said_, true)) return;
  watcher_.say(fmt::format("note: {}: {}; the run goes on with the CPU", where, error));
  if (results_) results_->add_device_error(error);
}

void OutputNote::look(const ClockTimes& clock) {
  constexpr double kLeast = 2;  // seconds, for what begins slowly
  const double writing = results_ ? results_->writing_seconds() : 0;
  if (writing < std::max(kLeast, clock.tracking) || std::exchange(said_, true)) return;
  watcher_.say(fmt::format(
      "note: outputs have taken {:.1f} s so far, and tracking {:.1f} s; is the disk of {} slow? "
      "The run is faster with another folder or with fewer outputs",
      writing, clock.tracking, results_->folder().string()));
}

}  // namespace hypotrack
