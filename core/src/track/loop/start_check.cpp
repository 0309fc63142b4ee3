#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/profile.hpp"
#include "track/loop/steps.hpp"
#include "track/sighting.hpp"

namespace hypotrack::internal {
namespace {

/// Returns whether the searches have left the start for a pose that few of them found.
bool is_doubtful(const LoopState& loop, const Candidate& best, std::size_t model) {
  return best.from_start && !best.reproduced[model] &&
         best.probabilities[model] >= loop.settings.thresholds.uncertain_above &&
         loop.given.is_left(model, best.found.state);
}

/// Compares a doubtful pose with others nearby that need no start. Looks for the model in the whole
/// pictures unless the best of them is surely right.
void try_other_poses(LoopState& loop, const Frame& frame, std::size_t model, Candidate& best) {
  constexpr double kAgo = 1;  // seconds since the models were as the start has them
  // As much as some of the searches from the start, which it follows.
  constexpr GlobalSearchSettings kEffort{.hypotheses = 200, .refined = 12};
  const std::size_t count = loop.tracks.size();
  best.probabilities[model] = GivenStart::doubted(best.probabilities[model]);
  RecoveryRequest request{
      .kept = loop.given.state(),
      .together = {},
      .seconds = std::vector<double>(count, kAgo),
      .unseen = std::vector<double>(count, std::numeric_limits<double>::infinity()),
      .sought = ModelFlags(count, false),
      .thorough = ModelFlags(count, false),
      .near_only = true,
      .effort = kEffort};
  request.sought[model] = true;
  for (const ModelTrack& track : loop.tracks) request.needed.push_back(track.needed());
  const auto part = static_cast<std::uint32_t>(200 + model);
  loop.finder.recover(frame, request, best, loop.seed_of(frame, part));
  const std::string why = "searches from around it end in different poses";
  loop.given.doubt(model, why);
  if (!(best.probabilities[model] >= loop.settings.thresholds.certain_above))
    loop.leave_start(model, why);
}

}  // namespace

void check_start(LoopState& loop, const Frame& frame, Candidate& best) {
  const ProfiledPart part("check start");
  for (std::size_t m = 0; m < loop.tracks.size(); ++m) {
    if (!is_at_start(loop.tracks[m].phase()) || !best.answers() || !best.shown[m]) continue;
    const std::optional<double> apart = loop.finder.seen_from(frame, m, best.found.state);
    if (apart && *apart > kElsewhere) {
      loop.leave_start(m, fmt::format("a detector sees it {:.0f} mm (mean over the landmarks) from "
                                      "where the search from the start ended",
                                      1000 * *apart));
      best.drop(m);
    } else if (apart && *apart < kHere) {
      best.unseen[m] = 0;
    } else if (is_doubtful(loop, best, m)) {
      try_other_poses(loop, frame, m, best);
    }
  }
}

}  // namespace hypotrack::internal
