#pragma once

#include <Eigen/Core>

#include "hypotrack/optimizer.hpp"

namespace hypotrack {

/// Builds the normal equations from the residuals r at a point (M) and those beside it (MxD):
/// column d of J is (beside.col(d) - r) * scale[d]. Columns of scale 0 are left out, whatever they
/// hold. Most residuals do not feel most parameters: what is equal costs a comparison only.
NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale);

}  // namespace hypotrack
