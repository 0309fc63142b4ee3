#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "track/occlude/occlusion.hpp"
#include "track/recover/recovery.hpp"
#include "track/search/frame_search.hpp"
#include "track/sighting.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"
#include "track/verify/pose_verifier.hpp"
#include "track/verify/ready_threads.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// One flag per model of a scene.
using ModelFlags = std::vector<bool>;

inline bool any(const ModelFlags& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// Least probability of a candidate that is worth searches around it.
inline constexpr double kLeastPromising = 0.02;

/// Time, in seconds, for which a pose stays detected after a detector last saw the model: a model
/// may be hard to see from some sides.
inline constexpr double kRemembered = 0.5;

/// A pose hypothesis for a frame and how well the pictures support it. The cost is infinite if no
/// pose was found.
struct Candidate {
  Found found{{}, std::numeric_limits<double>::infinity(), 0};
  ModelProbabilities probabilities = {};  ///< probability by model
  ModelFlags shown = {};    ///< models that this candidate poses; the state's values of the others
                            ///< are meaningless
  ModelFlags in_view = {};  ///< false: a search of the whole pictures did not find the model
  ModelFlags confirmed = {};        ///< searches from other starts ended in the same pose
  ModelFlags reproduced = {};       ///< a third of several searches ended in about this pose
  std::vector<double> unseen = {};  ///< seconds since a detector last saw the model near this
                                    ///< pose; infinity if never
  bool from_start = false;          ///< the searches began at a start, not at an earlier solution

  bool answers() const { return std::isfinite(found.cost); }
  /// Returns the smallest probability of the models shown; NaN if none is known.
  double probability() const;
  /// Takes a model out, which is in a wrong pose.
  void drop(std::size_t model);
  /// Returns whether it is so probable that no other pose has to be searched.
  bool is_sure() const { return probability() >= 0.95; }
  /// Returns whether a detector has seen the model there lately.
  bool is_detected(std::size_t model) const { return unseen[model] <= kRemembered; }
  /// Returns whether a model's pose is worth following: likely enough, or detected.
  bool may_be_right(std::size_t model, double probability) const {
    return probabilities[model] >= probability || is_detected(model);
  }
};

/// Input of a recovery: the last known poses and the models to find.
struct RecoveryRequest {
  Eigen::VectorXd kept;      ///< each model's last pose that was surely right
  Eigen::VectorXd together;  ///< the last state in which all models were surely right at once;
                             ///< empty: none
  std::vector<double> seconds = {};  ///< time since `kept`, by model; infinite: never seen
  std::vector<double> unseen = {};   ///< seconds, by model, since a detector saw it
  std::vector<double> needed = {};   ///< probability, by model, that an answer needs to count as
                                     ///< right
  ModelFlags sought;                 ///< models to find, or to find alternative poses for
  ModelFlags thorough = {};          ///< search the whole pictures although a detector would see it
  bool lost = false;                 ///< false: only alternative poses are wanted
  bool near_only = false;            ///< searches only around the answer
  GlobalSearchSettings effort = {};  ///< of that; zeros: the usual one
  bool contradicts = false;  ///< only asks detectors whether they see tracked models elsewhere
};

/// Finds the poses of one frame: searches from given starts, recovers lost models, and ranks the
/// candidates by their agreement with the pictures.
class CandidateFinder {
 public:
  /// Moves the optimizer out of `parts`. The scene must outlive the finder.
  CandidateFinder(const Scene& scene, TrackerParts& parts, const StatusSettings& settings);

  /// Searches a frame from `count` starts around `start`, before anything was found.
  Candidate begin(const Frame& frame, const Eigen::VectorXd& start, int count, std::uint64_t seed);

  /// Searches again from around `start` while nothing was ever found. Replaces `best` and returns
  /// true if the new candidate is likelier or `best` is out of view.
  bool begin_again(const Frame& frame, const Eigen::VectorXd& start, int count, std::uint64_t seed,
                   Candidate& best);

  /// Searches a frame for the flagged models from the cheapest of several starts (DxN).
  Candidate follow(const Frame& frame, const Eigen::MatrixXd& starts, const ModelFlags& models,
                   const Budget& budget, const std::optional<Reach>& reach, std::uint64_t seed);

  /// Finds the models that `best` lacks or has in doubtful poses. Models that the request does not
  /// seek stay as they are.
  void recover(const Frame& frame, const RecoveryRequest& request, Candidate& best,
               std::uint64_t seed);

  /// Searches this frame from a candidate of an earlier frame.
  Candidate go_on(const Frame& frame, const Candidate& from, std::uint64_t seed);

  /// Records the final candidate of a frame. Learns from those tracked models that are surely right
  /// (JudgeThresholds::certain_above).
  void accept(const Frame& frame, const Candidate& best, const ModelFlags& tracked);

  /// Returns whether a detector of a model is among the starters.
  bool detects(std::size_t model) const;
  /// Returns the distance between a model in two states: metres, mean over its landmarks.
  double distance(std::size_t model, const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  /// Returns the distance of a model from the place where detectors see it (Sighting::distance());
  /// nothing if none sees it, or if RecoverySettings::check is 0.
  std::optional<double> seen_from(const Frame& frame, std::size_t model,
                                  const Eigen::VectorXd& state) const;
  /// Returns whether all detectors of the last recovery saw a sought model elsewhere.
  bool contradicted() const { return contradicted_; }
  /// Returns which landmarks of a state something hides in both views, in the frame searched last;
  /// empty: none.
  std::vector<bool> hidden(const Eigen::VectorXd& state) const;
  /// Forgets the looks of a model, for its poses were wrong.
  void forget(std::size_t model) { verifier_.forget(model); }

  FrameSearch& search() { return search_; }
  const FrameSearch& search() const { return search_; }
  const PoseVerifier& verifier() const { return verifier_; }
  const Budget& budget() const { return budget_; }
  Budget& budget() { return budget_; }

 private:
  class ModelSearch;

  void learn(const Frame& frame, const Candidate& best, const ModelFlags& sure);
  /// Returns whether looks and backgrounds are learned from this frame, if it is right.
  bool is_time_to_learn() const;
  /// Searches a frame repeatedly from a state that may be some centimetres off.
  Candidate searched_from(const Frame& frame, const Eigen::VectorXd& state, std::uint64_t seed);
  Candidate verified(const Frame& frame, Found found);
  /// Looks for what hides the flagged models about where a state has them. Returns whether anything
  /// does, or did before.
  bool look_for_occluders(const Frame& frame, const Eigen::VectorXd& state,
                          const ModelFlags& models);
  /// Returns threads that help to judge poses found on a GPU: its search lets all others fall
  /// asleep. Null: there are no cores for them.
  ReadyThreads* ready_threads();
  /// Searches a frame from the cheapest of several starts.
  Candidate searched(const Frame& frame, const Eigen::MatrixXd& starts, const Budget& budget,
                     const std::optional<Reach>& reach, std::uint64_t seed);
  /// Returns the most probable candidate; among about equally probable ones the cheapest. All must
  /// show the same models. Prepares the search for the frame around the result.
  Candidate best_of(const Frame& frame, const std::vector<Candidate>& candidates,
                    const std::vector<double>& apart = {});
  void look_at(const Frame& frame, const Eigen::VectorXd& state);
  /// Returns the best candidate that has `model` in addition to those of `base`.
  std::optional<Candidate> with_model(const Frame& frame, const RecoveryRequest& request,
                                      const Candidate& base, Candidate& best, std::size_t model,
                                      const ModelFlags& held, std::uint64_t seed);
  /// Returns whether starters see another model where a state has this one, and not this one.
  bool is_of_another(std::size_t model, const Eigen::VectorXd& state) const;
  /// Returns whether two models of candidates are at the same place.
  bool is_same_place(const Candidate& a, std::size_t of_a, const Candidate& b,
                     std::size_t of_b) const;
  /// Returns the option that joins next: the most probable one. Of about equally probable ones at
  /// the same place the one whose model has moved least. Options without a candidate do not count.
  std::size_t best_option(const std::vector<std::optional<Candidate>>& options,
                          const RecoveryRequest& request) const;
  /// Returns the lost models that this one held in the last sure state.
  ModelFlags lost_with(const RecoveryRequest& request, const Candidate& base,
                       std::size_t model) const;
  /// Returns whether two candidates have a model in the same pose.
  bool is_same(const Candidate& a, const Candidate& b, std::size_t model) const;
  /// Returns whether a third of several candidates have a model about where the chosen one has it.
  /// From a wrong posture searches end in different poses.
  bool is_reproduced(const std::vector<Candidate>& all, const Candidate& chosen,
                     std::size_t model) const;
  /// Returns whether another candidate has a model in the same pose as the chosen one.
  bool is_confirmed(const std::vector<Candidate>& all, const Candidate& chosen,
                    std::size_t model) const;
  /// Returns whether any two likely candidates have a model in the same pose.
  bool has_confirmed(const std::vector<Candidate>& all, std::size_t model) const;
  /// Returns whether a model may join: the pictures support it, and still support the others.
  bool may_join(const Candidate& with, const Candidate& base, const RecoveryRequest& request,
                std::size_t model) const;

  const Scene& scene_;
  std::vector<Camera> cameras_;
  StatusSettings settings_;
  std::vector<std::unique_ptr<Starter>> starters_;
  Budget budget_;
  FrameSearch search_;
  PoseVerifier verifier_;
  std::unique_ptr<ReadyThreads> ready_;
  Occlusion occlusion_;
  double usual_probability_ = 0;  ///< of frames searched lately
  Recovery recovery_;
  std::vector<double> believed_;  ///< probability of each model in the last candidate accepted
  double believed_time_ = 0;      ///< time of that candidate
  int learned_ = 0;               ///< frames learned from
  bool contradicted_ = false;
  std::vector<Sighting> sightings_;  ///< by model, in the frame of a recovery; empty: not
                                     ///< asked for
};

}  // namespace internal
}  // namespace hypotrack
