#pragma once

#include <Eigen/Core>
#include <optional>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// World positions of the true landmarks (3xL, metres; NaN columns are unknown), nothing if the
/// frame has no truth.
HYPOTRACK_API std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene,
                                                             const Frame& frame);

}  // namespace hypotrack
