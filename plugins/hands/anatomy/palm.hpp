#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Directions of a hand at rest in the model's frame: unit vectors, perpendicular to each other.
struct PalmAxes {
  Eigen::Vector3d palm;     ///< out of the palm, to where the fingers bend
  Eigen::Vector3d fingers;  ///< from the wrist to the knuckles
  bool right = true;        ///< the hand's side
};

/// Returns the directions of a model with the landmarks wrist, index_mcp, little_mcp and
/// middle_tip. Returns nothing if it lacks one of them or nothing bends its middle finger to one
/// side.
std::optional<PalmAxes> palm_axes(const Model& model);

/// Returns palm_axes() as Model::directions() of a hand, `palm` and `fingers`; empty if there are
/// none.
std::vector<NamedDirection> palm_directions(const Model& model);

}  // namespace hypotrack
