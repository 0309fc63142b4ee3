#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// A shape that all frames share, and a pose for each of them.
struct JointTrial {
  Eigen::VectorXd shape;               ///< P numbers
  std::vector<Eigen::VectorXd> poses;  ///< states, one per frame
};

/// The cost of one frame about a trial, to second order in steps of the pose (D numbers) and, after
/// them, of the shape (P numbers).
struct FrameSystem {
  double cost = 0;
  Eigen::VectorXd gradient;  ///< D + P
  Eigen::MatrixXd hessian;   ///< square, positive semidefinite
};

/// What fit_jointly() minimises: the sum of the frames' costs and a prior of the shape.
class HYPOTRACK_API JointProblem {
 public:
  JointProblem() = default;
  virtual ~JointProblem();
  JointProblem(const JointProblem&) = delete;
  JointProblem& operator=(const JointProblem&) = delete;

  /// One per frame.
  virtual std::vector<FrameSystem> systems(const JointTrial& trial) = 0;
  /// Costs alone, one per frame; +infinity where there is none.
  virtual Eigen::VectorXd costs(const JointTrial& trial) = 0;
  /// A pose after a step of D numbers, within its bounds.
  virtual Eigen::VectorXd moved(const Eigen::VectorXd& pose, const Eigen::VectorXd& step) const = 0;
};

/// What is known of the shape beforehand: weight * sum(((shape - mean) / deviation)^2) is added to
/// the cost.
struct ShapePrior {
  Eigen::VectorXd mean, deviation, lower, upper;  ///< P numbers each; bounds are kept
  double weight = 0;
};

struct JointFit {
  JointTrial best;
  double first_cost = 0;  ///< of the trial that it began with, prior included
  double cost = 0;
  int iterations = 0;
};

/// Levenberg-Marquardt on shape and poses together. The poses, each in its own frame only, are
/// eliminated from the normal equations (Schur complement), so that the step of the shape knows
/// that the poses will follow. Gradients are taken as they are given, so costs need not be sums of
/// squares; where Hessians are larger than the curvature (pixels that a silhouette's edge passes
/// count by the step that moved it), a step that gains is tried at twice its length and so on. Of
/// its own step each pose takes all, a quarter or nothing, whichever is best for its frame.
/// Stops after `iterations` steps, when a step gains less than 1e-4 of the cost, or when `stop`
/// says so. Throws DataError if no frame has a finite cost.
HYPOTRACK_API JointFit fit_jointly(JointProblem& problem, JointTrial start, const ShapePrior& prior,
                                   int iterations, const std::function<bool()>& stop = {});

}  // namespace hypotrack
