#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/export.hpp"
#include "track/smooth/motion_prior.hpp"
#include "track/smooth/tile_highlights.hpp"

namespace hypotrack {

/// Looks for the motion, a state per frame, of lowest
///
///   sum over frames of their cost + sum over every three in a row of MotionPrior::cost()
///
/// by Levenberg-Marquardt over all frames at once: what a frame's pictures tell stays, what they do
/// not follows from the frames around it.
class HYPOTRACK_API TrajectoryFit {
 public:
  /// All must outlive it. The evaluator must have residuals. With `highlights` (or null) tiles have
  /// them taken off, as they are learned from the states so far.
  TrajectoryFit(const Scene& scene, Evaluator& evaluator, const MotionPrior& motion,
                TileHighlights* highlights = nullptr)
      : scene_(&scene), evaluator_(&evaluator), motion_(&motion), highlights_(highlights) {}

  /// Evaluations that one look at a frame takes.
  std::int64_t evaluations_per_look() const;

  /// Improves all moments but the first `fixed`, from where they are, with at most `evaluations`
  /// for each frame; at least two looks, or nothing is done. `sights` are as many as moments.
  /// Returns the evaluations that each frame seen has taken.
  std::int64_t improve(std::vector<Moment>& moments, const std::vector<Sight>& sights,
                       std::size_t fixed, std::int64_t evaluations);

 private:
  /// A frame's cost and its normal equations at a state.
  struct Look {
    double cost = 0;
    NormalEquations equations;
  };
  /// Sights without what highlights are there by the free moments' states.
  std::vector<Sight> matt(const std::vector<Moment>& moments, const std::vector<Sight>& sights,
                          std::size_t fixed);
  Look look(const Sight& sight, const Eigen::VectorXd& state, double blur);
  std::vector<Look> look_at_all(const std::vector<Moment>& moments,
                                const std::vector<Sight>& sights, std::size_t fixed, double blur);
  /// The step of every free moment, one after the other, for a motion whose speeds may change
  /// `looseness` times as much.
  Eigen::VectorXd step(const std::vector<Moment>& moments, const std::vector<Look>& looks,
                       const std::vector<double>& damping, double looseness,
                       std::size_t fixed) const;

  /// Which moments take their step, of `looks` and `seen` before and after it, so that all together
  /// cost least: one frame in which a step goes wrong does not hold up the others.
  std::vector<bool> worth_taking(const std::vector<Moment>& moments,
                                 const std::vector<Moment>& trial, const std::vector<Look>& looks,
                                 const std::vector<Look>& seen, double looseness) const;

  const Scene* scene_;
  Evaluator* evaluator_;
  const MotionPrior* motion_;
  TileHighlights* highlights_;
};

}  // namespace hypotrack
