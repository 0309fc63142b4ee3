#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/optimizer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Computes the normal equations from residuals r at a point (M) and at D neighbours (MxD). Column
/// d of J is (beside.col(d) - r) * scale[d]; columns with scale 0 are ignored.
NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale);

/// Returns `scale` with 0 for columns of infinite cost, whose residuals are undefined.
Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs);

}  // namespace internal
}  // namespace hypotrack
