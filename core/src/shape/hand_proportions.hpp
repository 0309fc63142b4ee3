#pragma once

#include <Eigen/Core>
#include <span>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the correlations of shape parameters among people (PxP). Parameters are those of a hand
/// by their names: `scale`, `thumb`, `index`, `middle`, `ring`, `little`, `width`. All others are
/// independent.
///
/// People with long fingers have five of them: if one is longer than the palm suggests, the others
/// are likely to be, too. So a fit that stretches all fingers alike is far more plausible than one
/// that stretches the middle finger and shortens its neighbours.
Eigen::MatrixXd shape_correlations(std::span<const ShapeParameter> parameters);

}  // namespace internal
}  // namespace hypotrack
