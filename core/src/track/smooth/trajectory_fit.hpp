#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cost/cost.hpp"
#include "hypotrack/export.hpp"
#include "track/smooth/motion_prior.hpp"
#include "track/smooth/tile_highlights.hpp"

namespace hypotrack {

/// Finds the motion, a state per frame, that minimises
///
///   sum over frames of their cost + sum over every three in a row of MotionPrior::cost()
///
/// by Levenberg-Marquardt over all frames at once. Dimensions that a frame's pictures determine
/// keep their values; the others follow from the neighbouring frames.
class HYPOTRACK_API TrajectoryFit {
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
  std::int64_t evaluations_per_look() const;

  /// Improves all moments but the first `fixed`, with at most `evaluations` per frame. `sights` has
  /// one entry per moment. Does nothing if the evaluations do not suffice for two linearisations.
  /// Returns the evaluations spent on each frame that has tiles.
  std::int64_t improve(std::vector<Moment>& moments, const std::vector<Sight>& sights,
                       std::size_t fixed, std::int64_t evaluations);

 private:
  /// A frame's cost and its normal equations at a state.
  struct Look {
    double cost = 0;
    NormalEquations equations;
  };
  /// Returns the sights without the highlights at the free moments' states.
  std::vector<Sight> matt(const std::vector<Moment>& moments, const std::vector<Sight>& sights,
                          std::size_t fixed);
  Look look(const Sight& sight, const Eigen::VectorXd& state, double blur);
  std::vector<Look> look_at_all(const std::vector<Moment>& moments,
                                const std::vector<Sight>& sights, std::size_t fixed, double blur);
  /// Returns the steps of all free moments, one after the other. `looseness` divides the prior's
  /// root weights: velocities may change by that factor more.
  Eigen::VectorXd step(const std::vector<Moment>& moments, const std::vector<Look>& looks,
                       const std::vector<double>& damping, double looseness,
                       std::size_t fixed) const;

  /// Chooses the moments that take their step so that the total cost is lowest. `looks` and `seen`
  /// are from before and after the step. A frame whose step fails does not hold up the others.
  std::vector<bool> worth_taking(const std::vector<Moment>& moments,
                                 const std::vector<Moment>& trial, const std::vector<Look>& looks,
                                 const std::vector<Look>& seen, double looseness) const;

  const Scene* scene_;
  Cost* cost_;
  StateResiduals* residuals_;  ///< of the cost
  const MotionPrior* motion_;
  TileHighlights* highlights_;
};

}  // namespace hypotrack
