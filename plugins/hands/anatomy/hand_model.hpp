#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "hand_points.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// The model's landmarks that the detector finds.
struct HandModel {
  /// Index of the model's landmark, by the detector's; -1: the model has none of that name.
  std::array<Eigen::Index, 21> landmarks;
  bool right = true;

  /// Returns the model's landmarks (3xL) in the detector's order.
  HandPoints3D in_detector_order(const Eigen::Matrix3Xd& of_model) const;
  /// Returns landmarks in the detector's order as `count` of the model (3xL). NaN: unknown.
  Eigen::Matrix3Xd in_model_order(const HandPoints3D& detected, Eigen::Index count) const;
};

/// Returns how a model has the detector's landmarks. Returns nothing if it is no hand: it lacks
/// wrist, knuckles or half of the others, or nothing bends its fingers to one side.
std::optional<HandModel> hand_model(const Model& model);

}  // namespace hypotrack
