#include <limits>
#include <optional>

#include "base/profile.hpp"
#include "track/loop/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Returns a candidate that poses no model.
Candidate without_poses(std::size_t models) {
  return {.probabilities = ModelProbabilities(models, std::numeric_limits<double>::quiet_NaN()),
          .shown = ModelFlags(models, false),
          .in_view = ModelFlags(models, true),
          .confirmed = ModelFlags(models, false),
          .reproduced = ModelFlags(models, false),
          .unseen = std::vector<double>(models, std::numeric_limits<double>::infinity())};
}

/// Searches from the given start, before there is any solution.
Candidate begin_at_start(LoopState& loop, const Frame& frame) {
  const bool several = loop.recovers() && loop.given.is_early();
  Candidate best =
      loop.finder.begin(frame, loop.given.state(),
                        several ? loop.settings.recovery.first_restarts : 1, loop.seed_of(frame));
  loop.given.count_search();
  return best;
}

/// Searches from the given start again while the models may still come to it.
void begin_again(LoopState& loop, const Frame& frame, Candidate& best) {
  constexpr int kSeveralEvery = 5;  // searches
  const bool several = loop.given.count_search() % kSeveralEvery == 0;
  const int starts = several ? loop.settings.recovery.first_restarts : 1;
  if (loop.finder.begin_again(frame, loop.given.state(), starts, loop.seed_of(frame, 9), best))
    loop.trail.begin_anew();
}

}  // namespace

Candidate follow(LoopState& loop, const Frame& frame) {
  const ProfiledPart part("follow");
  if (!loop.trail.has_solution() && loop.given.expects_any()) return begin_at_start(loop, frame);
  const ModelFlags models = loop.followed();
  if (!any(models)) return without_poses(models.size());
  CandidateFinder& finder = loop.finder;
  finder.search().show(models);
  Budget budget = finder.budget();
  budget.usual_cost = loop.tracks[0].usual_cost();
  std::optional<Reach> reach;
  if (loop.recovers())
    reach = reach_within(loop.settings.motion, loop.trail.seconds_until(frame.time));
  const Eigen::MatrixXd starts =
      loop.trail.predicted(frame.time, loop.tiles(), finder.budget().evaluations);
  Candidate best = finder.follow(frame, starts, models, budget, reach, loop.seed_of(frame));
  if (loop.recovers() && loop.given.expects_any() && !finder.verifier().experienced() &&
      best.probability() < loop.settings.thresholds.uncertain_above)
    begin_again(loop, frame, best);
  return best;
}

}  // namespace hypotrack::internal
