#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "track/frame_search.hpp"
#include "track/judge/judge.hpp"
#include "track/recover/recovery.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"

namespace hypotrack {

/// One flag per model of a scene.
using ModelFlags = std::vector<bool>;

/// An answer to a frame and what the pictures say of it. Without an answer the cost is infinite.
struct Candidate {
  Found found{{}, std::numeric_limits<double>::infinity(), 0};
  Verdict verdict = {};     ///< by model
  ModelFlags shown = {};    ///< models that it has; what the state has of the others does not count
  ModelFlags in_view = {};  ///< false: the whole pictures do not show the model
  ModelFlags confirmed = {};  ///< searches from other starts ended in the same pose, too

  bool answers() const { return std::isfinite(found.cost); }
  /// The smallest probability of the models shown; NaN where nothing is known.
  double probability() const;
};

/// What to find models again by.
struct LossReport {
  Eigen::VectorXd kept;              ///< where each model was surely right last
  Eigen::VectorXd together;          ///< where all were when that was so of all at once
  std::vector<double> seconds = {};  ///< since then, by model
  std::vector<double> needed = {};   ///< probability by model, from which on it is right
  ModelFlags sought;                 ///< models to look for, or to look for other poses of
  bool lost = false;                 ///< false: to look for other poses only
  bool near_only = false;            ///< looks around the answer only
};

/// Answers frames: searches from given starts, looks for lost models, and judges all by the
/// pictures.
class HYPOTRACK_API CandidateFinder {
 public:
  /// Takes the optimizer of the parts. The scene must outlive it.
  CandidateFinder(const Scene& scene, TrackerParts& parts, const StatusSettings& settings);

  /// Searches a frame from around a start, before anything was found: from `count` starts.
  Candidate begin(const Frame& frame, const Eigen::VectorXd& start, int count, std::uint64_t seed);

  /// Searches from around a start again while nothing was ever found. Returns whether that gave a
  /// likelier answer than `best`, or `best` is out of view: it is replaced then.
  bool begin_again(const Frame& frame, const Eigen::VectorXd& start, int count, std::uint64_t seed,
                   Candidate& best);

  /// Searches a frame for some models from the cheapest of several starts (DxN).
  Candidate follow(const Frame& frame, const Eigen::MatrixXd& starts, const ModelFlags& models,
                   const Budget& budget, const std::optional<Reach>& reach, std::uint64_t seed);

  /// Finds models that an answer lacks or has in doubtful places. Models that the report does not
  /// seek stay in the answer.
  void recover(const Frame& frame, const LossReport& report, Candidate& best, std::uint64_t seed);

  /// Searches on from an answer to an earlier frame.
  Candidate go_on(const Frame& frame, const Candidate& from, std::uint64_t seed);

  /// Takes note of the answer that a frame was given, and learns from those of its tracked models
  /// that are surely right (StatusSettings::surely_above).
  void accept(const Frame& frame, const Candidate& best, const ModelFlags& tracked);

  FrameSearch& search() { return search_; }
  const FrameSearch& search() const { return search_; }
  const Judge& judge() const { return judge_; }
  const Budget& budget() const { return budget_; }
  Budget& budget() { return budget_; }

 private:
  void learn(const Frame& frame, const Candidate& best, const ModelFlags& sure);
  Candidate judged(const Frame& frame, Found found);
  /// The best by probability and, among those alike, by cost. All show the same models. The frame
  /// is then taken in around it.
  Candidate best_of(const Frame& frame, const std::vector<Candidate>& candidates,
                    const std::vector<double>& apart = {});
  void look_at(const Frame& frame, const Eigen::VectorXd& state);
  /// The best answer that has a model in addition to those of `base`.
  std::optional<Candidate> with_model(const Frame& frame, const LossReport& report,
                                      const Candidate& base, Candidate& best, std::size_t model,
                                      const ModelFlags& held, std::uint64_t seed);
  /// Lost models that were at this one when all were surely right.
  ModelFlags lost_with(const LossReport& report, const Candidate& base, std::size_t model) const;
  /// Whether two answers have a model in the same pose.
  bool is_same(const Candidate& a, const Candidate& b, std::size_t model) const;
  /// Whether another of all answers has a model where the chosen one has it.
  bool is_confirmed(const std::vector<Candidate>& all, const Candidate& chosen,
                    std::size_t model) const;
  /// Whether two likely answers have.
  bool has_confirmed(const std::vector<Candidate>& all, std::size_t model) const;
  /// Whether a model may join: the pictures show it, and still show the others.
  bool may_join(const Candidate& with, const Candidate& base, const LossReport& report,
                std::size_t model) const;

  const Scene& scene_;
  StatusSettings settings_;
  Budget budget_;
  FrameSearch search_;
  Judge judge_;
  Recovery recovery_;
  std::vector<double> believed_;  ///< probability of each model in the last answer
  double believed_time_ = 0;      ///< of that answer
  int learned_ = 0;               ///< frames
};

}  // namespace hypotrack
