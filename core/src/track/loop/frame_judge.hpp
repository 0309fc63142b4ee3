#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/solution.hpp"
#include "track/loop/loop_state.hpp"
#include "track/search/candidate_finder.hpp"
#include "track/status.hpp"
#include "track/uncertainty.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Calls tracked models uncertain.
void call_uncertain(Solution& solution);

/// Judges the result of a frame: how sure each model's pose is, and how far off.
class FrameJudge {
 public:
  /// The loop's state must outlive the judge.
  explicit FrameJudge(LoopState& loop);

  /// Returns the evaluations that it takes per frame.
  std::int64_t evaluations() const { return uncertainty_ ? uncertainty_->evaluations() : 0; }

  /// Makes a solution of a frame that was not searched: all unknown, `missing`.
  Solution unjudged(const Frame& frame) const;
  /// Judges a frame's candidate. Every model's track moves to its next phase. Returns the models'
  /// statuses. Those of the solution are doubted further where something hides a model.
  std::vector<Status> judge(const Frame& frame, const Candidate& best, Solution& solution);
  /// Judges a frame in which nothing can be followed, and whose search is not done.
  void judge_without_search(const Frame& frame, Solution& solution);
  /// Raises the sigmas of models without a pose to the distance that they may have moved.
  void widen(const Frame& frame, Solution& solution) const;

 private:
  /// Collects the measurements that all models share, and the sigmas of the solution.
  StatusMeasures shared_measures(const Frame& frame, const Candidate& best, Solution& solution);
  StatusMeasures measures_of(std::size_t model, const Frame& frame, const Candidate& best,
                             const Solution& solution, StatusMeasures shared) const;
  /// Flags landmarks that something hides. Calls models uncertain whose hidden landmarks may have
  /// moved far: the search goes on from them, as the part that pictures show is right.
  void doubt_hidden(const Frame& frame, const Candidate& best, Solution& solution);

  LoopState& loop_;
  std::optional<PoseUncertainty> uncertainty_;
};

}  // namespace internal
}  // namespace hypotrack
