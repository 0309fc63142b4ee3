#pragma once

#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/solution.hpp"
#include "track/loop/loop_state.hpp"
#include "track/loop/recovery_plan.hpp"
#include "track/search/candidate_finder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// The steps of the tracker's loop, in their order. RecoveryPlan stands before recover(), FrameJudge
// before accept().

/// Searches a frame from the last solution or, before there is one, from the given start. Returns
/// a candidate without a pose if no model is followed.
Candidate follow(LoopState& loop, const Frame& frame);

/// Checks whether detectors and pictures support the poses that the given start led to. Models that
/// they contradict leave the start, and the candidate if a detector sees them elsewhere.
void check_start(LoopState& loop, const Frame& frame, Candidate& best);

/// Searches a frame for what a plan requests, and replaces `best` if it finds better. Models that
/// detectors see elsewhere again and again are forgotten, and leave `best`.
void recover(LoopState& loop, const Frame& frame, const RecoveryRequest& request, Candidate& best);

/// Searches a frame from a candidate that a search in the background found in an earlier frame.
/// Looks nearby for models that are lost then.
void catch_up(LoopState& loop, RecoveryPlan& plan, const Frame& frame, Candidate& best);

/// Lets the next search go on from those poses of a judged candidate that may be right. The other
/// models stay where they were right last. Returns the models that go on.
ModelFlags accept(LoopState& loop, const Frame& frame, const Candidate& best,
                  const std::vector<Status>& judgement);

/// Lets the next search go on from where all models were right last: nothing was found.
void accept_nothing(LoopState& loop, const Frame& frame);

/// Learns from the models that are tracked: motion, last right poses and, if surely right, looks.
void learn(LoopState& loop, const Frame& frame, const Candidate& best,
           const std::vector<Status>& judgement);

}  // namespace internal
}  // namespace hypotrack
