#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "track/frame_search.hpp"
#include "track/judge/judge.hpp"
#include "track/motion_limits.hpp"
#include "track/recover/background_model.hpp"
#include "track/recover/held.hpp"
#include "track/recover/place_finder.hpp"
#include "track/recover/pose_search.hpp"
#include "track/recover/recovery_settings.hpp"
#include "track/recover/searched_places.hpp"

namespace hypotrack {

/// Where a lost model was when it was last surely tracked.
struct LastKnown {
  Eigen::VectorXd state;  ///< of the scene; the other models are where they are now
  double seconds = 0;     ///< since then
  /// Where it may be now; empty if nobody knows.
  Eigen::VectorXd hint = {};
  bool near_hint_only = false;  ///< looks nowhere else
  /// Where all models were when all were surely tracked; empty: unknown.
  Eigen::VectorXd before = {};
};

/// States that a recovery found at one place.
struct Candidates {
  std::vector<Eigen::VectorXd> states;  ///< of the whole scene, best first; none that is hopeless
  std::int64_t evaluations = 0;
};

/// Looks for a lost model in whole pictures: around where it was, and wherever both views show its
/// colours.
class HYPOTRACK_API Recovery {
 public:
  /// A frame in which one model is looked for.
  struct Quest {
    FrameSearch& search;
    const Frame& frame;
    Judge& judge;
    std::size_t model;
    LastKnown last;
    std::vector<bool> hidden = {};        ///< models that are nowhere; the lost one, too
    std::vector<Held> held = {};          ///< those of them that move with the lost one
    std::vector<double> covered = {};     ///< share of each model that others hide
    bool in_view = true;                  ///< false: no picture shows colours of the lost model
    std::vector<PoseGuess> guesses = {};  ///< where it may be, likeliest first
  };

  /// The scene must outlive it.
  Recovery(const Scene& scene, const std::vector<Camera>& cameras,
           const RecoverySettings& settings);

  /// Finds places where a model may be, without those that were searched in vain and look the same.
  /// Other models with `shown` are where `last` has them; those with `held` move with the lost one
  /// (held_by()), the rest is nowhere. What is given must outlive the quest.
  Quest begin(FrameSearch& search, const Frame& frame, Judge& judge, LastKnown last,
              std::size_t model, const std::vector<bool>& shown, const std::vector<bool>& held,
              const MotionLimits& limits);

  /// Finds up to settings.searched poses of the model, and of what it holds, at one of the places.
  Candidates find(const Quest& quest, const PoseGuess& guess, const MotionLimits& limits,
                  std::uint64_t seed);

  /// Remembers the postures of the models with `tracked`, which are surely right, and what is
  /// behind them.
  void remember(const Frame& frame, const Eigen::VectorXd& state, const std::vector<bool>& tracked);

 private:
  std::vector<PoseGuess> guesses(const Quest& quest, const Places& places,
                                 const MotionLimits& limits);
  Places places(const Quest& quest) const;
  /// Where the model is if it has moved with another, as what a hand holds.
  PoseGuess beside(const Quest& quest, std::size_t other) const;
  void learn_backgrounds(const Frame& frame, const Eigen::VectorXd& state);
  /// Whether a state hides models that are not hidden without the lost one.
  static bool hides_others(const Quest& quest, const Eigen::VectorXd& state,
                           const ColorMap& colors);

  const Scene& scene_;
  std::vector<Camera> cameras_;
  RecoverySettings settings_;
  std::vector<std::unique_ptr<PoseSearch>> searches_;
  std::vector<PlaceFinder> finders_;
  std::vector<SearchedPlaces> searched_;        ///< by model
  std::vector<SearchedPlaces> searched_held_;   ///< with what it holds
  std::array<BackgroundModel, 2> backgrounds_;  ///< of the reduced pictures
};

}  // namespace hypotrack
