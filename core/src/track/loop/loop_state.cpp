#include "track/loop/loop_state.hpp"

#include <utility>

namespace hypotrack::internal {
namespace {

/// Returns the settings with those of the judge, who is not asked where no term looks at pictures.
StatusSettings with_judge(const TrackerParts& parts) {
  StatusSettings settings = parts.status;
  if (!parts.judge) return settings;
  settings.judged = look_at_pictures(parts.objective);
  settings.thresholds = parts.judge->thresholds();
  return settings;
}

}  // namespace

LoopState::LoopState(const Scene& of, TrackerParts& parts, Eigen::VectorXd start,
                     std::uint64_t seed_of_frames)
    : scene(of),
      settings(with_judge(parts)),
      seed(seed_of_frames),
      given(of, std::move(start), !parts.begins_by_looking),
      finder(of, parts, settings),
      tracks(of, parts.cameras, given.state(), !parts.begins_by_looking, settings),
      trail(of, parts.search.prediction, parts.one_euro, given.state()) {}

ModelFlags LoopState::followed() const {
  ModelFlags out;
  for (std::size_t m = 0; m < tracks.size(); ++m) {
    const Phase phase = tracks[m].phase();
    const bool is_followed = has_pose(phase) || is_at_start(phase) || !recovers();
    out.push_back(trail.has_solution() && is_followed);
  }
  return out;
}

std::uint64_t LoopState::seed_of(const Frame& frame) const {
  // splitmix64 of both numbers
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(frame.index) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

void LoopState::leave_start(std::size_t model, const std::string& why) {
  given.contradict(model, why);
  tracks[model].leave_start();
}

void LoopState::forget(std::size_t model) {
  finder.forget(model);
  tracks[model].forget();
}

void LoopState::restart() {
  for (std::size_t m = 0; m < tracks.size(); ++m)
    if (!given.expects(m)) forget(m);
  tracks.restart();
  if (!recovers()) trail.return_to_start();
  trail.begin_anew();
  finder.search().remember(nullptr);
}

}  // namespace hypotrack::internal
