#pragma once

#include <oneapi/tbb/task_arena.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/output.hpp"
#include "track/loop/background_search.hpp"
#include "track/loop/frame_judge.hpp"
#include "track/loop/frame_record.hpp"
#include "track/loop/loop_state.hpp"
#include "track/loop/picture_watch.hpp"
#include "track/loop/recovery_plan.hpp"
#include "track/search/optimizer_trace.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tracks a scene from frame to frame. The search of a frame starts from the last solution, or from
/// its extrapolated motion. Every model has a phase (phase.hpp).
class SceneTracker {
 public:
  /// `start` is the state from which the first frame's search starts, or, with
  /// `parts.begins_by_looking`, any state in view. Equal seeds and input give
  /// equal solutions, except with recovery in the background. The scene must outlive the tracker.
  SceneTracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed);
  ~SceneTracker();

  /// Finds the scene in the next frame. `record`, if given, receives how, and `trace` how the
  /// searches converged. Both stay empty while a search runs in the background. It uses at most the
  /// threads of EvaluateSettings, apart from OpenCV's. Throws Stopped by check_stop(); the tracker
  /// can go on with the next frame. Later calls throw errors of learning, which goes on.
  Solution track(const Frame& frame, SearchRecord* record = nullptr, FrameTrace* trace = nullptr);

  /// Forgets where the models are: the next frame looks for them again. Without recovery the search
  /// begins anew from the start.
  void search_anew();

  /// Prepares the frame as track() does, without a search. Throws if the cameras do not see the
  /// start or an objective cannot work with the frame.
  void check(const Frame& frame);

  /// Returns the fault of a frame that track() would report, without a search. Call it with frames
  /// in their order.
  ViewFault fault_of(const Frame& frame);

  /// Returns a warning if frames like this one would count as lost or uncertain at the start; empty
  /// otherwise. The frame must be usable.
  std::string problem_of_start(const Frame& frame) const;

  /// Returns what the user should know of the start that was given, since the last call.
  std::vector<std::string> take_start_notes() { return loop_.given.take_notes(); }

  /// Returns the tiles that the search of `frame`, the last one tracked, saw; with the highlights.
  Observation seen(const Frame& frame) const {
    return loop_.finder.search().seen(pictures_.steadied(frame));
  }

  /// Returns what the pictures show to be wrong with the cameras, since the last call.
  std::vector<std::string> take_rig_notes() { return pictures_.take_notes(); }
  /// Returns the number of threads that it may use.
  int threads() const { return arena_.max_concurrency(); }
  /// Returns the name of the backend that evaluates hypotheses, for the run's log.
  std::string backend() const { return loop_.finder.search().cost().backend(); }
  /// Returns the error after which the CPU took the place of a device; empty: there was none.
  const std::string& device_error() const { return loop_.finder.search().device_error(); }

 private:
  Solution track_here(const Frame& frame, SearchRecord* record, FrameTrace* trace);
  /// Calls find(), again on the CPU if the device failed and the settings ask for that.
  void find_or_leave_device(const Frame& frame, Solution& solution, SearchRecord* record,
                            FrameTrace* trace);
  void find(const Frame& frame, Solution& solution, SearchRecord* record, FrameTrace* trace);
  /// Searches a frame from the result of the search in the background, once it has one.
  void find_from_background(const Frame& frame, Solution& solution);
  /// Ends a frame without a result, while the search goes on in the background.
  void stay_lost(const Frame& frame, Solution& solution);
  /// Judges the result of a frame, goes on from it and learns from it.
  void conclude(const Frame& frame, const Candidate& best, Solution& solution);

  LoopState loop_;
  std::vector<ObjectiveTerm> terms_;  ///< for records
  PictureWatch pictures_;
  FrameJudge judge_;
  RecoveryPlan plan_;
  tbb::task_arena arena_;        ///< of the threads that the settings allow
  BackgroundSearch background_;  ///< ends before what it uses
};

}  // namespace internal
}  // namespace hypotrack
