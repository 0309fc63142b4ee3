#include <algorithm>
#include <limits>

#include "base/profile.hpp"
#include "track/loop/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Forgets checked models that detectors saw elsewhere only, in several checks.
void forget_contradicted(LoopState& loop, const ModelFlags& checked, Candidate& best) {
  for (std::size_t m = 0; m < loop.tracks.size(); ++m) {
    if (!checked[m]) continue;
    const bool is_contradicted = loop.tracks[m].take_check(loop.finder.contradicted());
    if (!is_contradicted || loop.given.expects(m)) continue;
    loop.forget(m);
    best.drop(m);
  }
}

/// Returns whether pictures support all models where starters that detect them see them.
bool is_agreed(const LoopState& loop, const Candidate& best) {
  for (std::size_t m = 0; m < loop.tracks.size(); ++m)
    if (!(best.unseen[m] <= 0 && best.probabilities[m] >= loop.settings.thresholds.tracked_above))
      return false;
  return true;
}

/// Returns whether a candidate is the first one that has all models, though not surely.
bool is_first_guess(const LoopState& loop, const Candidate& best) {
  return !loop.given.expects_any() && !loop.finder.verifier().experienced() &&
         std::ranges::find(best.shown, false) == best.shown.end() &&
         best.probability() >= loop.settings.thresholds.uncertain_above && !best.is_sure() &&
         !is_agreed(loop, best);
}

}  // namespace

void recover(LoopState& loop, const Frame& frame, const RecoveryRequest& request, Candidate& best) {
  const ProfiledPart part("recover");
  loop.finder.recover(frame, request, best, loop.seed_of(frame, 7));
  if (request.contradicts) forget_contradicted(loop, request.sought, best);
  // From here on it is as if this pose had been given as the start.
  if (is_first_guess(loop, best))
    loop.finder.begin_again(frame, best.found.state, loop.settings.recovery.first_restarts,
                            loop.seed_of(frame, 8), best);
}

void catch_up(LoopState& loop, RecoveryPlan& plan, const Frame& frame, Candidate& best) {
  if (!(best.answers() && best.probability() >= kLeastPromising)) {
    best.found.cost = std::numeric_limits<double>::infinity();
    return;
  }
  best = loop.finder.go_on(frame, best, loop.seed_of(frame));
  RecoveryRequest request = plan.next(loop, frame, best);
  request.near_only = true;
  if (request.lost) loop.finder.recover(frame, request, best, loop.seed_of(frame, 7));
}

}  // namespace hypotrack::internal
