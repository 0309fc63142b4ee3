#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/uncertainty_settings.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Estimates the error of each landmark of a solution from the residuals r around it. J is their
/// Jacobian (central differences in the tangent space). s^2 is the mean square of the residuals
/// that J touches. P is the diagonal prior covariance of a pose about which the images say nothing.
/// Then
///
///   C = (J^T J / (noise s)^2 + P^-1)^-1,   dx = -C J^T r / (noise s)^2
///
/// are the covariance of the pose and the step to the minimum of the linearised cost, which a
/// search that ended early has not reached. With L the Jacobian of a landmark and d its
/// displacement by dx (clamped to joint limits),
///
///   sigma^2 = trace(L C L^T) + |d|^2 + floor^2
///
/// is the expected square of its distance from the truth. A limb that no pixel shows moves no
/// residual and keeps P. Residuals of terms that look at the pose only are left out beside terms
/// that look at pictures: a prior that holds a limb does not tell where it is.
class PoseUncertainty {
 public:
  /// The scene must outlive the object.
  PoseUncertainty(const Scene& scene, const UncertaintySettings& settings);

  /// Returns the number of evaluations per frame: two per dimension of the tangent space, and one.
  std::int64_t evaluations() const { return 2 * steps_.size() + 1; }

  /// Computes the sigma of every landmark in metres, for a normalised state of the prepared frame.
  /// The cost must have residuals. Returns infinity if a residual or cost is not finite.
  Eigen::VectorXd of(Cost& cost, const Eigen::VectorXd& state) const;

 private:
  const Scene* scene_;
  UncertaintySettings settings_;
  Eigen::VectorXd steps_;  ///< of the finite differences, per dimension of the tangent space
  Eigen::VectorXd width_;  ///< square roots of the diagonal of P
};

/// Information of the linearised residuals about a pose: J^T J / s^2 and J^T r / s^2, with s^2 the
/// mean square of the residuals that J touches.
struct ResidualInformation {
  Eigen::MatrixXd a;  ///< DxD
  Eigen::VectorXd g;  ///< D
};

/// Computes the information from finite differences. `residuals` (Mx(2D+1)) has the residuals of a
/// pose, then those below and above it in each of D dimensions, `width` (D) apart. A dimension of
/// width 0 touches nothing.
ResidualInformation residual_information(const Eigen::MatrixXf& residuals,
                                         const Eigen::VectorXd& width);

}  // namespace internal
}  // namespace hypotrack
