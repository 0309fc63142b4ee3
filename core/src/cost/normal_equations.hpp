#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"
#include "hypotrack/optimizer.hpp"

namespace hypotrack {

/// Builds the normal equations from the residuals r at a point (M) and those beside it (MxD):
/// column d of J is (beside.col(d) - r) * scale[d]. Columns of scale 0 are left out, whatever they
/// hold. Most residuals do not feel most parameters: what is equal costs a comparison only.
HYPOTRACK_API NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                               const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                               const Eigen::VectorXd& scale);

/// `scale` with 0 for columns whose cost is infinite: their residuals may be anything.
Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs);

}  // namespace hypotrack
