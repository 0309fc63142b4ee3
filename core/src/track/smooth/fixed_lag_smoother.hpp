#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/fallback_cost.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/smooth/motion_prior.hpp"
#include "track/smooth/trajectory_fit.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Fixed-lag smoother: improves each state with the frames of a window before and after it. It fits
/// the frames of a window together (TrajectoryFit), from the states that were found. Then it
/// settles all but those of the last `lag`. The last two settled states constrain the next window's
/// motion.
class FixedLagSmoother {
 public:
  /// The scene must outlive it. Throws ConfigError if a term has no residuals, or if the settings
  /// do not fit each other or the scene. With `highlights` it removes highlights from the tiles.
  FixedLagSmoother(const Scene& scene, std::vector<ObjectiveTerm> terms,
                   const EvaluateSettings& evaluate, const FixedLagSettings& settings,
                   bool highlights = false);

  /// Adds the next frame: the state found, and the tiles that its search saw, with highlights. Give
  /// no tiles if the frame tells nothing about the scene.
  void add(FrameTiles tiles, const TimedState& found);

  /// A state that does not change any more.
  struct Settled {
    Eigen::VectorXd state;
    std::int64_t evaluations = 0;  ///< evaluations of the smoothing for it
  };
  /// Returns the states settled since the last call, in the order of add().
  std::vector<Settled> take();
  /// Settles and returns the remaining states, when no more frames come.
  std::vector<Settled> finish();

  /// Returns why the device was left; empty: it was not.
  const std::string& device_error() const { return cost_.device_error(); }

 private:
  void settle(std::size_t count);
  /// Improves the states that wait. Returns the evaluations spent on each frame.
  std::int64_t improve();

  const Scene& scene_;

  FixedLagSettings settings_;
  FallbackCost cost_;
  MotionPrior motion_;
  std::optional<TileHighlights> highlights_;
  TrajectoryFit fit_;
  std::vector<TimedState> states_;  ///< last two settled ones, then waiting ones
  std::vector<FrameTiles> tiles_;
  std::vector<std::int64_t> evaluations_;
  std::size_t fixed_ = 0;
  std::vector<Settled> settled_;
};

}  // namespace internal
}  // namespace hypotrack
