#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "track/candidate_finder.hpp"
#include "track/color/photometric.hpp"
#include "track/one_euro.hpp"
#include "track/prediction.hpp"
#include "track/search_space.hpp"
#include "track/smooth/hindsight_settings.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"
#include "track/uncertainty.hpp"

namespace hypotrack {

/// The answer for one frame.
struct Solution {
  int frame = 0;
  double time = 0;
  Status status = Status::missing;  ///< the worst of the models'
  std::vector<Status> models;       ///< by model
  double cost = 0;                  ///< NaN if the frame was missing
  std::int64_t evaluations = 0;
  double seconds = 0;     ///< from the frame to the answer: tiles, features and search
  Eigen::VectorXd state;  ///< normalised; smoothed if the tracker was told to
  /// How far off each landmark of the scene may be, in metres: the root of the expected square.
  /// Empty if the tracker was not told to say, NaN if the frame was missing.
  Eigen::VectorXd sigma;
  /// Probability by model that it is where it was found, by what the pictures show; NaN: they do
  /// not tell.
  std::vector<double> probabilities = {};
};

/// Follows a scene from frame to frame: the search of a frame starts from the last solution, or
/// from where its motion leads.
class HYPOTRACK_API Tracker {
 public:
  /// The scene must outlive the tracker. `start` is the state that the first frame's search starts
  /// from. Equal seeds and input give equal solutions.
  Tracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed);
  ~Tracker();
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  Solution track(const Frame& frame);

  /// Takes the frame in as track() does and does not search. Throws what stands in the way: a start
  /// that the cameras do not see, a frame that an objective cannot work with.
  void check(const Frame& frame);

  /// What people should know of a start at which frames like this usable one count as lost or
  /// uncertain; nothing of a good one.
  std::string problem_of_start(const Frame& frame) const;

  /// What the search of `frame`, the last one tracked, saw of it; with the highlights.
  Observation seen(const Frame& frame) const;

  /// What evaluates hypotheses, for the run's protocol.
  std::string backend() const;

 private:
  /// What is known of one model.
  struct ModelTrack {
    ModelTrack(const StatusSettings& settings, Eigen::Index first, Eigen::Index count)
        : monitor(settings), first_landmark(first), landmarks(count) {}

    StatusMonitor monitor;
    Eigen::Index first_landmark, landmarks;  ///< among the scene's
    Status status = Status::missing;
    double kept_time = 0;   ///< when it was surely right last
    int confirmations = 0;  ///< frames left in which other poses are looked for, too
    /// Its motion then, per second, as tangent.hpp has differences; empty: unknown.
    Eigen::VectorXd velocity = {};

    /// Whether searches go on from its last state.
    bool is_followed() const { return status != Status::lost && status != Status::absent; }
    /// What a vector of the scene's landmarks has of the model's.
    auto part_of(Eigen::VectorXd& of_scene) const {
      return of_scene.segment(first_landmark, landmarks);
    }
  };

  void find(const Frame& frame, Solution& solution);
  /// Searches on from the last state; no answer while all is lost.
  Candidate follow(const Frame& frame);
  /// Looks for what an answer lacks, or has in a doubtful place: here or, where nothing else can be
  /// followed, in the background. False: the background looks, and the frame has no answer.
  bool complete(const Frame& frame, Candidate& best);
  LossReport report(const Frame& frame, const Candidate& best);
  void conclude(const Frame& frame, const Candidate& best, Solution& solution);
  void judge_models(const Frame& frame, const Candidate& best, Solution& solution);
  // Recovery in the background. While a job runs, nothing else uses the finder.
  void start_job(const Frame& frame, const LossReport& loss, const Candidate& best);
  void wait_for_job(const Frame& frame, Solution& solution);
  void stay_lost(const Frame& frame, Solution& solution);

  bool recovers() const { return settings_.recovery.enabled && settings_.evidence; }
  ModelFlags followed() const;
  /// States that the search of a frame may start from, the middle one, which is seen, first.
  Eigen::MatrixXd possible_starts(double time);
  void go_on_from(const Frame& frame, const Candidate& best, const ModelFlags& good);
  void keep(const Frame& frame, const Candidate& best, const ModelFlags& tracked);
  /// Where a model was when it was surely right last, moved on for a moment, in `state`.
  void extrapolate(std::size_t model, double time, Eigen::VectorXd& state) const;
  /// No sigma of a lost model is below what it may have moved since.
  void widen(const Frame& frame, Solution& solution) const;
  Eigen::VectorXd smoothed(const Solution& solution);

  const Scene& scene_;
  StatusSettings settings_;
  Eigen::VectorXd first_;  ///< where the first search starts
  CandidateFinder finder_;
  std::optional<PoseUncertainty> uncertainty_;
  Predictor predictor_;
  OneEuroFilter smoother_;
  bool smoothing_;
  std::vector<ModelTrack> models_;
  Eigen::VectorXd kept_;      ///< where each model was surely right last
  Eigen::VectorXd together_;  ///< where all were when that was so of all at once
  Eigen::VectorXd state_;     ///< where the next search starts
  double time_ = 0;           ///< of it
  Eigen::VectorXd output_;    ///< the last state that was given out
  int begun_ = 0;             ///< frames searched before anything was found
  bool found_any_ = false;    ///< whether `state_` is a solution
  unsigned doubts_ = 0;       ///< doubtful answers of late
  std::uint64_t seed_;
  std::future<Candidate> job_;
};

}  // namespace hypotrack
