#include <memory>
#include <utility>

#include "base/profile.hpp"
#include "track/loop/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the models whose poses the next search goes on from.
ModelFlags good_ones(const LoopState& loop, const Candidate& best,
                     const std::vector<Status>& judgement) {
  ModelFlags good;
  for (const Status status : judgement)
    good.push_back(status == Status::tracked || status == Status::uncertain);
  if (!best.answers() || !(loop.tiles().visible_share(best.found.state) > 0)) return good;
  // Without recovery, tracking continues from any pose in view, as in the paper. With it, this
  // holds for models that are not known yet and expected at the start.
  const bool begins = !loop.given.is_early() || any(good);
  for (std::size_t m = 0; m < good.size(); ++m) {
    const bool takes_any = !loop.recovers() || (begins && is_at_start(loop.tracks[m].phase()));
    good[m] = good[m] || (best.shown[m] && takes_any);
  }
  return good;
}

}  // namespace

ModelFlags accept(LoopState& loop, const Frame& frame, const Candidate& best,
                  const std::vector<Status>& judgement) {
  const ProfiledPart part("accept");
  ModelFlags good = good_ones(loop, best, judgement);
  Eigen::VectorXd state = loop.trail.state();
  for (std::size_t m = 0; m < good.size(); ++m) {
    const Scene::Item& item = loop.scene.items()[m];
    const Eigen::Index size = item.model->dimension();
    if (good[m])
      state.segment(item.offset, size) = best.found.state.segment(item.offset, size);
    else if (loop.recovers())
      loop.tracks[m].extrapolate(frame.time, state);
  }
  if (loop.recovers() && loop.tiles().visible_share(state) == 0) state = loop.tracks.kept();
  if (!any(good)) {
    loop.trail.move_to(std::move(state));
    return good;
  }
  loop.tracks.departure().remember(state, frame.time, good);
  loop.trail.add(std::move(state), frame.time);
  loop.finder.search().remember(
      std::make_shared<PreviousSolution>(
          PreviousSolution{frame.index, frame.time, best.found.cost, best.found.state, {}}),
      &frame);
  return good;
}

void accept_nothing(LoopState& loop, const Frame& frame) {
  Eigen::VectorXd state = loop.trail.state();
  for (const ModelTrack& track : loop.tracks) track.extrapolate(frame.time, state);
  loop.trail.move_to(std::move(state));
}

void learn(LoopState& loop, const Frame& frame, const Candidate& best,
           const std::vector<Status>& judgement) {
  const ProfiledPart part("learn");
  ModelFlags tracked;
  for (const Status status : judgement) tracked.push_back(status == Status::tracked);
  loop.finder.accept(frame, best, tracked);
  loop.tracks.take(tracked, best.found.state, loop.trail.velocity(), frame.time);
  for (std::size_t m = 0; m < tracked.size(); ++m)
    if (loop.finder.verifier().experienced(m)) loop.tracks[m].learn();
}

}  // namespace hypotrack::internal
