#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/search.hpp"
#include "track/loop/given_start.hpp"
#include "track/loop/scene_tracks.hpp"
#include "track/loop/trail.hpp"
#include "track/search/candidate_finder.hpp"
#include "track/status.hpp"
#include "track/tracker_parts.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What the steps of the tracker's loop share.
struct LoopState {
  /// Moves the optimizer and the starters out of `parts`. The scene must outlive the object.
  LoopState(const Scene& scene, TrackerParts& parts, Eigen::VectorXd start, std::uint64_t seed);

  const Scene& scene;
  const StatusSettings settings;
  const std::uint64_t seed;
  GivenStart given;
  CandidateFinder finder;
  SceneTracks tracks;
  Trail trail;

  /// Returns whether lost models are looked for.
  bool recovers() const { return settings.recovery.enabled && settings.judged; }
  /// Returns whether models may be looked for that a candidate lacks: pictures must tell which of
  /// several poses is right.
  bool can_recover(const Candidate& best) const {
    return recovers() && !(best.answers() && std::isnan(best.probability()));
  }
  /// Returns the models that searches go on from. Without recovery they go on from any pose.
  ModelFlags followed() const;
  /// Returns the seed of a frame, which does not depend on the frames before, and of a part of its
  /// search.
  std::uint64_t seed_of(const Frame& frame) const;
  std::uint64_t seed_of(const Frame& frame, std::uint32_t part) const {
    return seed_of_part(seed_of(frame), part);
  }
  const TileMaker& tiles() const { return finder.search().tiles(); }

  /// Looks for a model in the pictures, as without a start. `why` goes to the user.
  void leave_start(std::size_t model, const std::string& why);
  /// Drops what was learned of a model's looks: its poses were wrong.
  void forget(std::size_t model);
  /// Begins a search anew for all models, where the given start is trusted from there.
  void restart();
};

}  // namespace internal
}  // namespace hypotrack
