#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// What linearised residuals say about a pose: J^T J / s^2 and J^T r / s^2, s^2 the mean square of
/// the residuals that J touches.
struct ResidualInformation {
  Eigen::MatrixXd a;  ///< DxD
  Eigen::VectorXd g;  ///< D
};

/// `residuals` (Mx(2D+1)) are those of a pose, then of those below and above it in each of D
/// numbers, `width` (D) apart. A number with a width of 0 touches nothing.
HYPOTRACK_API ResidualInformation residual_information(const Eigen::MatrixXf& residuals,
                                                       const Eigen::VectorXd& width);

}  // namespace hypotrack
