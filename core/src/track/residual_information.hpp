#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

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
