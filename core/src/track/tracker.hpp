#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "geometry/tiles.hpp"
#include "hindsight/hindsight_settings.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "judge/judge.hpp"
#include "metrics/landmark_errors.hpp"
#include "recover/recovery.hpp"
#include "track/frame_search.hpp"
#include "track/one_euro.hpp"
#include "track/photometric.hpp"
#include "track/prediction.hpp"
#include "track/search_space.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"
#include "track/uncertainty.hpp"

namespace hypotrack {

/// The answer for one frame.
struct Solution {
  int frame = 0;
  double time = 0;
  Status status = Status::missing;
  double cost = 0;  ///< NaN if the frame was missing
  std::int64_t evaluations = 0;
  double seconds = 0;     ///< from the frame to the answer: tiles, features and search
  Eigen::VectorXd state;  ///< normalised; smoothed if the tracker was told to
  /// How far off each landmark of the scene may be, in metres: the root of the expected square.
  /// Empty if the tracker was not told to say, NaN if the frame was missing.
  Eigen::VectorXd sigma;
  /// Probability that every model is where it was found, by what the pictures show; NaN where they
  /// do not tell.
  double probability = std::numeric_limits<double>::quiet_NaN();
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
  /// An answer and what the pictures say of it. Without an answer the cost is infinite.
  struct Candidate {
    Found found{{}, std::numeric_limits<double>::infinity(), 0};
    Verdict verdict;
    bool in_view = true;  ///< false: the whole pictures do not show the models
  };
  /// The last state that was surely right.
  struct Kept {
    Eigen::VectorXd state;
    double time = 0;
    std::optional<Eigen::VectorXd> velocity = {};  ///< per second, as tangent.hpp has differences
  };

  void find(const Frame& frame, Solution& solution);
  /// Searches the first frame from several starts.
  Candidate begin(const Frame& frame);
  /// Searches on from the last state; no answer while lost.
  Candidate follow(const Frame& frame);
  /// Replaces an answer by a better one, from anywhere that motion allows or, with `near_only`,
  /// from around the answer.
  void recover(const Frame& frame, Candidate& best, bool near_only = false);
  /// Searches the frame as it is taken in until that gains little.
  Found settled(const Eigen::VectorXd& start, std::uint64_t seed);
  void answer(const Frame& frame, const Candidate& best, Solution& solution);
  // Recovery in the background. While a job runs, nothing else uses the search and the judge.
  void start_job(const Frame& frame, const Candidate& best);
  void wait_for_job(const Frame& frame, Solution& solution);
  void stay_lost(const Frame& frame, Solution& solution);
  void conclude(const Frame& frame, const Candidate& best, Solution& solution);
  Candidate judged(const Frame& frame, Found found);
  /// The best by probability and, among those alike, by cost. The frame is then taken in around it.
  Candidate best_of(const Frame& frame, const std::vector<Candidate>& candidates);
  void look_at(const Frame& frame, const Eigen::VectorXd& state);
  bool known(const Candidate& candidate) const;
  bool is_right(const Candidate& candidate) const;
  /// Whether to look for other poses although an answer will do, because it hardly does.
  bool is_time_to_doubt(const Candidate& best);
  bool recovers() const { return settings_.recovery.enabled && settings_.evidence; }

  /// States that the search of a frame may start from, the middle one, which is seen, first.
  Eigen::MatrixXd possible_starts(double time);
  void learn(const Frame& frame, const Candidate& best);
  bool is_time_to_learn() const;
  void go_on_from(const Eigen::VectorXd& found, const Frame& frame);
  void keep_last(const Frame& frame);
  /// The last state that was surely right, moved on for a moment.
  Eigen::VectorXd extrapolated(double time) const;
  /// No sigma of a scene that is lost is below what it may have moved since.
  void widen(Eigen::VectorXd& sigma, double seconds) const;
  Eigen::VectorXd smoothed(const Solution& solution);
  /// Mean over a model's landmarks, of the model where it is largest; NaN without sigmas.
  double largest_sigma(const Eigen::VectorXd& sigma) const;

  const Scene& scene_;
  StatusSettings settings_;
  Budget budget_;
  Eigen::VectorXd first_;  ///< where the first search starts
  FrameSearch search_;
  Judge judge_;
  Recovery recovery_;
  StatusMonitor monitor_;
  LandmarkLayout landmarks_;
  std::optional<PoseUncertainty> uncertainty_;
  Predictor predictor_;
  OneEuroFilter smoother_;
  bool smoothing_;
  Kept kept_;
  Eigen::VectorXd state_;   ///< where the next search starts
  double time_ = 0;         ///< of it
  Eigen::VectorXd output_;  ///< the last state that was given out
  Status last_status_ = Status::missing;
  std::vector<double> believed_;  ///< probability of each model in the last answer
  int begun_ = 0;                 ///< frames searched before anything was found
  bool found_any_ = false;        ///< whether `state_` is a solution
  int confirmations_ = 0;         ///< frames left in which an answer is confirmed
  int doubts_ = 0;                ///< frames whose answers hardly did
  int learned_ = 0;               ///< frames
  std::uint64_t seed_;
  std::future<Candidate> job_;
};

}  // namespace hypotrack
