#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "hypotrack/search_record.hpp"
#include "hypotrack/solution.hpp"
#include "track/candidate_finder.hpp"
#include "track/color/photometric.hpp"
#include "track/faults/picture_checks.hpp"
#include "track/faults/steady_brightness.hpp"
#include "track/loop/departure.hpp"
#include "track/loop/given_start.hpp"
#include "track/one_euro.hpp"
#include "track/prediction.hpp"
#include "track/rig/model_rows.hpp"
#include "track/rig/rig_watch.hpp"
#include "track/search_space.hpp"
#include "track/search_trace.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"
#include "track/uncertainty.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tracks a scene from frame to frame. The search of a frame starts from the last solution, or from
/// its extrapolated motion.
class SceneTracker {
 public:
  /// `start` is the state from which the first frame's search starts, or, with
  /// `parts.begins_by_looking`, any state in view. Equal seeds and input give
  /// equal solutions, except with recovery in the background. The scene must outlive the tracker.
  SceneTracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed);
  ~SceneTracker();
  SceneTracker(const SceneTracker&) = delete;
  SceneTracker& operator=(const SceneTracker&) = delete;

  /// Finds the scene in the next frame. `record`, if given, receives how, and `trace` how the
  /// searches converged. Both stay empty while a search runs in the background. Throws Stopped by
  /// check_stop(); the tracker can go on with the next frame.
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
  std::vector<std::string> take_start_notes() { return given_.take_notes(); }

  /// Returns the tiles that the search of `frame`, the last one tracked, saw; with the highlights.
  Observation seen(const Frame& frame) const;

  /// Returns what the pictures show to be wrong with the cameras, since the last call.
  std::vector<std::string> take_rig_notes() {
    return rig_ ? rig_->take_notes() : std::vector<std::string>();
  }
  /// Returns the name of the backend that evaluates hypotheses, for the run's log.
  std::string backend() const;
  /// Returns the error after which the CPU took the place of a device; empty: there was none.
  const std::string& device_error() const { return finder_.search().device_error(); }

 private:
  /// Tracking state of one model.
  struct ModelTrack {
    ModelTrack(const StatusSettings& settings, Eigen::Index first, Eigen::Index count)
        : monitor(settings), first_landmark(first), landmarks(count) {}

    StatusMonitor monitor;
    Eigen::Index first_landmark, landmarks;  ///< range among the scene's landmarks
    Status status = Status::missing;
    double kept_time = 0;  ///< time at which it was surely right last
    double seen_time = -std::numeric_limits<double>::infinity();  ///< at which a start saw it last
    int confirmations = 0;   ///< frames left in which alternative poses are searched
    unsigned sought = 0;     ///< frames in which it was looked for since it was tracked
    int contradictions = 0;  ///< checks in a row in which starts saw it elsewhere only
    /// Motion at kept_time, per second, a difference of tangent.hpp; empty: unknown.
    Eigen::VectorXd velocity = {};

    /// Returns whether searches continue from its last state.
    bool is_followed() const { return status != Status::lost && status != Status::absent; }
    /// Returns the model's part of a vector over the scene's landmarks.
    auto part_of(Eigen::VectorXd& of_scene) const {
      return of_scene.segment(first_landmark, landmarks);
    }
  };

  void find(const Frame& frame, Solution& solution, SearchRecord* record, FrameTrace* trace);
  /// Calls find(), again on the CPU if the device failed and the settings ask for that.
  void find_or_leave_device(const Frame& frame, Solution& solution, SearchRecord* record,
                            FrameTrace* trace);
  /// Ends the recording and tracing of searches.
  void unwatch();
  /// Evaluates the answer and the truth in the tiles of the answer.
  void compare_with_truth(const Candidate& best, FrameTrace& trace);
  /// Records the tiles, the answer drawn in them and the terms' maps of it.
  void describe(const Frame& frame, const Candidate& best, SearchRecord& record);
  /// Searches from the last state. Returns no pose while all models are lost.
  Candidate follow(const Frame& frame);
  /// Searches for what a candidate lacks or has in doubtful poses. Starts a background job instead
  /// if the settings say so and no model can be followed. Returns false then: the frame has no
  /// result.
  bool complete(const Frame& frame, Candidate& best);
  /// Looks whether detectors and pictures support the poses that the given start led to.
  void test_given_start(const Frame& frame, Candidate& best);
  /// Returns whether the searches have left the start for a pose that few of them found.
  bool is_doubtful(const Candidate& best, std::size_t model) const;
  /// Compares a doubtful pose with others nearby that need no start. Looks for the model in the
  /// whole pictures unless the best of them is surely right.
  void try_other_poses(const Frame& frame, std::size_t model, Candidate& best);
  /// Returns whether pictures support all models where starts that recognise them see them.
  bool is_agreed(const Candidate& best) const;
  /// Takes the model out of a candidate that has it in a wrong pose.
  void drop(std::size_t model, Candidate& best) const;
  /// Looks for a model in the pictures, as without a start. `why` goes to the user.
  void leave_start(std::size_t model, const std::string& why);
  /// Loses models of which the starts saw nothing where they are, but saw them elsewhere, in
  /// several checks.
  void doubt_contradicted(const ModelFlags& checked, Candidate& best);
  RecoveryRequest recovery_request(const Frame& frame, const Candidate& best);
  void conclude(const Frame& frame, const Candidate& best, Solution& solution);
  /// Flags landmarks that something hides. Calls models uncertain whose hidden landmarks may have
  /// moved far.
  void doubt_hidden(const Frame& frame, const Candidate& best, Solution& solution);
  void judge_models(const Frame& frame, const Candidate& best, Solution& solution);
  // Recovery in the background. While a job runs, nothing else uses the finder.
  void start_job(const Frame& frame, const RecoveryRequest& request, const Candidate& best);
  void wait_for_job(const Frame& frame, Solution& solution);
  void stay_lost(const Frame& frame, Solution& solution);
  /// Ends a running job and drops what it found.
  void end_job();

  bool recovers() const { return settings_.recovery.enabled && settings_.evidence; }
  /// Returns whether a model that was never surely found is looked for in pictures.
  bool looks_for(std::size_t model) const {
    return !given_.expects(model) && !finder_.verifier().experienced(model);
  }
  /// Returns whether a model that was never surely found is awaited at the start that was given.
  bool awaits(std::size_t model) const {
    return given_.expects(model) && !finder_.verifier().experienced(model);
  }
  /// Watches the rig. Calls models uncertain that are tracked with cameras whose depth may be
  /// wrong.
  void doubt_rig(const Frame& frame, Solution& solution);
  /// Returns a frame as it is searched: as bright as before, and as the calibration says.
  Frame steadied(const Frame& frame) const;
  ModelFlags followed() const;
  /// Returns states from which the search of a frame may start. The middle one, which is in view,
  /// comes first.
  Eigen::MatrixXd possible_starts(double time);
  void go_on_from(const Frame& frame, const Candidate& best, const ModelFlags& good);
  void keep(const Frame& frame, const Candidate& best, const ModelFlags& tracked);
  /// Writes into `state` the model's last sure pose, extrapolated by its fading motion.
  void extrapolate(std::size_t model, double time, Eigen::VectorXd& state) const;
  /// Raises the sigmas of lost models to the distance they may have moved since.
  void widen(const Frame& frame, Solution& solution) const;
  Eigen::VectorXd smoothed(const Solution& solution);

  const Scene& scene_;
  std::vector<ObjectiveTerm> terms_;  ///< for records
  StatusSettings settings_;
  GivenStart given_;
  Departure departure_;
  CandidateFinder finder_;
  std::optional<PictureChecks> picture_checks_;
  SteadyBrightness brightness_;
  std::optional<RigWatch> rig_;  ///< of a pair of views that are compared
  std::optional<ModelRows> model_rows_;
  std::optional<PoseUncertainty> uncertainty_;
  Predictor predictor_;
  OneEuroFilter smoother_;
  bool smoothing_;
  std::vector<ModelTrack> models_;
  Eigen::VectorXd kept_;      ///< each model's last pose that was surely right
  Eigen::VectorXd together_;  ///< the last state in which all models were surely right at once
  Eigen::VectorXd state_;     ///< start of the next search
  Eigen::VectorXd seen_;      ///< time, by landmark, at which it was tracked and not hidden
  double time_ = 0;           ///< time of `state_`
  Eigen::VectorXd output_;    ///< last state returned
  int begun_ = 0;             ///< frames searched before anything was found
  bool found_any_ = false;    ///< whether `state_` is a solution
  unsigned looked_ = 0;       ///< frames with a doubtful first pose
  double checked_ = 0;        ///< time at which starts last looked whether a model is elsewhere
  std::size_t checks_ = 0;    ///< number of these checks, which take turns among the models
  unsigned doubts_ = 0;       ///< recent count of doubtful poses
  std::uint64_t seed_;
  std::atomic<bool> job_unwanted_ = false;  ///< tells the job to end
  std::future<Candidate> job_;
};

}  // namespace internal
}  // namespace hypotrack
