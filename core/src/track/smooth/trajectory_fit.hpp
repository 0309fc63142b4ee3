#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "track/smooth/motion_prior.hpp"
#include "track/smooth/tile_highlights.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Finds the motion, a state per frame, that minimises
///
///   sum over frames of their cost + sum over every three in a row of MotionPrior::cost()
///
/// by Levenberg-Marquardt over all frames at once. Dimensions that a frame's pictures determine
/// keep their values; the others follow from the neighbouring frames.
class TrajectoryFit {
 public:
  /// The cost must have residuals. `highlights` (may be null) removes highlights from the
  /// tiles, learned from the states so far. All arguments must outlive the fit.
  TrajectoryFit(const Scene& scene, Cost& cost, const MotionPrior& motion,
                TileHighlights* highlights = nullptr)
      : scene_(&scene),
        cost_(&cost),
        residuals_(cost.least_squares()),
        motion_(&motion),
        highlights_(highlights) {}

  /// Returns the evaluations that linearising one frame takes.
  std::int64_t evaluations_per_linearization() const;

  /// Improves all states but the first `fixed`, with at most `evaluations` per frame. `tiles` has
  /// one entry per state. Does nothing if the evaluations do not suffice for two linearisations.
  /// Returns the evaluations spent on each frame that has tiles.
  std::int64_t improve(std::vector<TimedState>& states, const std::vector<FrameTiles>& tiles,
                       std::size_t fixed, std::int64_t evaluations);

 private:
  /// A frame's cost and its normal equations at a state.
  struct LinearizedFrame {
    double cost = 0;
    NormalEquations equations;
  };
  /// Returns the tiles with the highlights removed, for the free states.
  std::vector<FrameTiles> without_highlights(const std::vector<TimedState>& states,
                                             const std::vector<FrameTiles>& tiles,
                                             std::size_t fixed);
  LinearizedFrame linearize(const FrameTiles& tiles, const Eigen::VectorXd& state, double blur);
  std::vector<LinearizedFrame> linearize_all(const std::vector<TimedState>& states,
                                             const std::vector<FrameTiles>& tiles,
                                             std::size_t fixed, double blur);
  /// Returns the steps of all free states, one after the other. `looseness` divides the prior's
  /// root weights: velocities may change by that factor more.
  Eigen::VectorXd step(const std::vector<TimedState>& states,
                       const std::vector<LinearizedFrame>& frames,
                       const std::vector<Damping>& damping, double looseness,
                       std::size_t fixed) const;

  /// Chooses the states that take their step so that the total cost is lowest. `frames` and
  /// `trial_frames` are from before and after the step. A frame whose step fails does not hold up
  /// the others.
  std::vector<bool> worth_taking(const std::vector<TimedState>& states,
                                 const std::vector<TimedState>& trial,
                                 const std::vector<LinearizedFrame>& frames,
                                 const std::vector<LinearizedFrame>& trial_frames,
                                 double looseness) const;

  const Scene* scene_;
  Cost* cost_;
  StateResiduals* residuals_;  ///< of the cost
  const MotionPrior* motion_;
  TileHighlights* highlights_;
};

}  // namespace internal
}  // namespace hypotrack
