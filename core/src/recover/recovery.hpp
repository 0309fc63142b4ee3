#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "judge/judge.hpp"
#include "recover/place_finder.hpp"
#include "recover/pose_search.hpp"
#include "recover/recovery_settings.hpp"
#include "track/frame_search.hpp"
#include "track/motion_limits.hpp"

namespace hypotrack {

/// Where the scene was when it was last surely tracked.
struct LastKnown {
  Eigen::VectorXd state;
  double seconds = 0;  ///< since then
  /// Where it may be now; empty if nobody knows.
  Eigen::VectorXd hint = {};
  bool near_hint_only = false;  ///< looks nowhere else
};

/// What a recovery found: states of the whole scene worth a search, best first.
struct Candidates {
  std::vector<Eigen::VectorXd> states;
  std::int64_t evaluations = 0;
  bool in_view = true;  ///< false: no picture shows colours of the lost models
};

/// Looks for lost models in whole pictures: around where they were, and wherever both views show
/// their colours.
class HYPOTRACK_API Recovery {
 public:
  /// The scene must outlive it.
  Recovery(const Scene& scene, const std::vector<Camera>& cameras,
           const RecoverySettings& settings);

  /// Finds up to settings.searched states. `lost` says which models to look for; the others stay
  /// where `last` has them.
  Candidates find(FrameSearch& search, const Frame& frame, Judge& judge, const LastKnown& last,
                  const std::vector<bool>& lost, const MotionLimits& limits, std::uint64_t seed);

  /// Remembers the postures of a scene that is surely tracked.
  void remember(const Eigen::VectorXd& state);

 private:
  /// Finds poses of one model, best first: costs are how unlikely the pictures make them. Glances
  /// at every place and searches the best ones thoroughly.
  std::vector<Refined> poses(FrameSearch& search, const Frame& frame, Judge& judge,
                             std::size_t model, const Eigen::VectorXd& base,
                             const std::vector<bool>& hidden, std::vector<PoseGuess> guesses,
                             std::uint64_t seed);
  std::vector<PoseGuess> guesses(std::size_t model, const Places& places, const LastKnown& last,
                                 const MotionLimits& limits) const;

  const Scene& scene_;
  RecoverySettings settings_;
  std::vector<std::unique_ptr<PoseSearch>> searches_;
  std::vector<PlaceFinder> finders_;
};

}  // namespace hypotrack
