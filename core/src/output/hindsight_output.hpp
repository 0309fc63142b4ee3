#pragma once

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "hypotrack/export.hpp"
#include "output/run_output.hpp"
#include "track/smooth/hindsight.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// Hands a run's frames to its output at once or, with hindsight, when their states are settled.
class HYPOTRACK_API HindsightOutput {
 public:
  /// The output must outlive it. Without `hindsight` (null) frames are written as they come.
  HindsightOutput(std::unique_ptr<Hindsight> hindsight, RunOutput& output)
      : hindsight_(std::move(hindsight)), output_(&output) {}

  /// Takes in the frame that `tracker` has just solved and returns the solution's error in metres:
  /// NaN where it is not known, or not yet.
  double add(const Tracker& tracker, const Frame& frame, const Solution& solution);

  /// What still waits, changed as far as it can be.
  void finish();
  /// The same, as it was found or last changed: after an error.
  void finish_unchanged();

 private:
  struct Waiting {
    Frame frame;  ///< without its pictures
    Solution solution;
  };
  void write(const std::vector<Hindsight::Settled>& settled);

  std::unique_ptr<Hindsight> hindsight_;
  RunOutput* output_;
  std::deque<Waiting> waiting_;
};

}  // namespace hypotrack
