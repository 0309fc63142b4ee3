#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A shape that all frames share, and a pose for each frame.
struct JointTrial {
  Eigen::VectorXd shape;               ///< P numbers
  std::vector<Eigen::VectorXd> poses;  ///< states, one per frame
};

/// Quadratic model of one frame's cost around a trial. Steps are of the pose (D numbers), then of
/// the shape (P numbers).
struct FrameSystem {
  double cost = 0;
  Eigen::VectorXd gradient;  ///< D + P
  Eigen::MatrixXd hessian;   ///< square, positive semidefinite
};

/// The cost that fit_jointly() minimises, as a sum over frames. A prior of the shape is added to
/// it.
class JointProblem {
 public:
  JointProblem() = default;
  virtual ~JointProblem();
  JointProblem(const JointProblem&) = delete;
  JointProblem& operator=(const JointProblem&) = delete;

  /// Returns the quadratic models at a trial, one per frame.
  virtual std::vector<FrameSystem> systems(const JointTrial& trial) = 0;
  /// Returns the costs, one per frame; +infinity where a trial is infeasible.
  virtual Eigen::VectorXd costs(const JointTrial& trial) = 0;
  /// Returns a pose after a step of D numbers, within its bounds.
  virtual Eigen::VectorXd moved(const Eigen::VectorXd& pose, const Eigen::VectorXd& step) const = 0;
};

/// Gaussian prior of the shape. With d = shape - mean it adds weight * d^T precision d to the cost.
struct ShapePrior {
  Eigen::VectorXd mean, lower, upper;  ///< P numbers each; bounds are hard
  Eigen::MatrixXd precision;           ///< PxP, the inverse of the covariance
  double weight = 0;
};

struct JointFit {
  JointTrial best;
  double first_cost = 0;  ///< of the start, prior included
  double cost = 0;
  int iterations = 0;
};

/// Minimises over shape and poses together by Levenberg-Marquardt. Each pose occurs in its own
/// frame only, so a Schur complement eliminates the poses from the normal equations. The step of
/// the shape thus accounts for the poses that follow it.
///
/// Gradients are used as given, so costs need not be sums of squares. Hessians may exceed the
/// curvature, as pixels that a silhouette's edge passes count by the step that moved it. So a step
/// that gains is tried at twice its length and so on. Each pose takes all, a quarter or nothing of
/// its own step, whichever is best for its frame.
///
/// Stops after `iterations` steps, when a step gains less than 1e-4 of the cost, or when `stop`
/// returns true. Throws DataError if no frame has a finite cost.
JointFit fit_jointly(JointProblem& problem, JointTrial start, const ShapePrior& prior,
                     int iterations, const std::function<bool()>& stop = {});

}  // namespace internal
}  // namespace hypotrack
