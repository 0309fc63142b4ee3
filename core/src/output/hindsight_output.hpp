#pragma once

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "hypotrack/export.hpp"
#include "output/run_output.hpp"
#include "track/scene_tracker.hpp"
#include "track/smooth/hindsight.hpp"

namespace hypotrack {

/// Passes a run's frames to its output: at once or, with fixed-lag smoothing, when their states are
/// settled.
class HYPOTRACK_API HindsightOutput {
 public:
  /// The output must outlive the object. Without `hindsight` (null) frames are written as they
  /// come.
  HindsightOutput(std::unique_ptr<Hindsight> hindsight, RunOutput& output)
      : hindsight_(std::move(hindsight)), output_(&output) {}

  /// Adds the frame that `tracker` has just solved. Returns the solution's error in metres, NaN
  /// where it is unknown, also while it waits.
  double add(const SceneTracker& tracker, const Frame& frame, const Solution& solution);

  /// Smooths and writes the frames that still wait.
  void finish();
  /// Writes the frames that still wait as they are. Use it after an error.
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
