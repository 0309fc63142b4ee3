#pragma once

#include <Eigen/Core>

#include "cost/evaluator.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "track/uncertainty_settings.hpp"

namespace hypotrack {

/// How far each landmark of a solution may be off, from the residuals r of the cost around it. With
/// J their Jacobian (central differences in the tangent space), s^2 the mean square of those that J
/// touches, and P the diagonal covariance of a pose that the images say nothing about,
///
///   C = (J^T J / (noise s)^2 + P^-1)^-1,   dx = -C J^T r / (noise s)^2
///
/// are the covariance of the pose and the way to the minimum of the linearised cost, which a search
/// that ended early has left. With L the Jacobian of a landmark and d the way that dx, kept to the
/// limits of joints, moves it,
///
///   sigma^2 = trace(L C L^T) + |d|^2 + floor^2
///
/// is the expected square of its distance from the truth. A finger that no pixel shows moves no
/// residual and keeps P. Beside terms that look at pictures, those that look at the pose only do
/// not count: to be held where it was tells a finger nothing about where it is.
class HYPOTRACK_API PoseUncertainty {
 public:
  /// The scene must outlive it.
  PoseUncertainty(const Scene& scene, const UncertaintySettings& settings);

  /// What a frame's sigmas take: two evaluations per number of the tangent space, and one.
  std::int64_t evaluations() const { return 2 * steps_.size() + 1; }

  /// Sigma of every landmark in metres, for a normalised state of the prepared frame. The evaluator
  /// must have residuals. Where one of them or a cost is not finite: infinity.
  Eigen::VectorXd of(Evaluator& evaluator, const Eigen::VectorXd& state) const;

 private:
  const Scene* scene_;
  UncertaintySettings settings_;
  Eigen::VectorXd steps_;  ///< of the differences, per number of the tangent space
  Eigen::VectorXd width_;  ///< roots of the diagonal of P
};

}  // namespace hypotrack
