#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Directions of a hand at rest in the model's frame: unit vectors, perpendicular to each other.
struct PalmAxes {
  Eigen::Vector3d palm;     ///< out of the palm, to where the fingers bend
  Eigen::Vector3d fingers;  ///< from the wrist to the knuckles
};

/// Returns the directions of a model with the landmarks wrist, index_mcp, little_mcp and
/// middle_tip. Returns nothing if it lacks one of them or nothing bends its middle finger to one
/// side.
std::optional<PalmAxes> palm_axes(const Model& model);

}  // namespace internal
}  // namespace hypotrack
