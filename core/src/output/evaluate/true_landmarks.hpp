#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tables.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the world positions of the true landmarks (3xL, metres; NaN columns are unknown or
/// absent). Returns nothing if the frame has no truth.
std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene, const Frame& frame);

/// Returns for each landmark of the scene whether its model is absent. `absent_models` has a flag
/// per model; if it is empty, so is the result.
std::vector<bool> absent_landmarks(const Scene& scene, const std::vector<bool>& absent_models);
/// Returns for each landmark of the scene the index of its model.
std::vector<std::size_t> landmark_owners(const Scene& scene);
/// Returns for each of `models` models whether it is absent: some of its landmarks are and none is
/// known. `owners` are the landmarks' models. Empty if no model is absent.
std::vector<bool> absent_models(const LandmarkRow& row, std::span<const std::size_t> owners,
                                std::size_t models);

}  // namespace internal
}  // namespace hypotrack
