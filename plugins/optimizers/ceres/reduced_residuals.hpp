#pragma once

#include <Eigen/Core>

#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

/// D residuals r and their DxD Jacobian J.
struct ReducedResiduals {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// Returns the residuals that have these normal equations: J^T J = a and J^T r = g. Their squares
/// sum to the part of the cost that steps can change. The matrix may be singular.
ReducedResiduals reduce(const NormalEquations& equations);

}  // namespace hypotrack
