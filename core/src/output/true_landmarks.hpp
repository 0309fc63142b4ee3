#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/tables.hpp"

namespace hypotrack {

/// World positions of the true landmarks (3xL, metres; NaN columns are unknown or absent), nothing
/// if the frame has no truth.
HYPOTRACK_API std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene,
                                                             const Frame& frame);

/// For each landmark of the scene, whether its model is absent, from the same for each model; empty
/// if that is.
HYPOTRACK_API std::vector<bool> absent_landmarks(const Scene& scene,
                                                 const std::vector<bool>& absent_models);
/// The reverse: a model is absent if landmarks of it are and none of them is known. Empty if no
/// model is.
HYPOTRACK_API std::vector<bool> absent_models(const Scene& scene, const LandmarkRow& row);

}  // namespace hypotrack
