#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "hand_detection.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack::hands {

/// How a model of a hand has the landmarks that the detector finds.
struct HandModel {
  /// Index of the model's landmark, by the detector's; -1: the model has none of that name.
  std::array<Eigen::Index, 21> landmarks;
  bool right = true;

  /// Returns landmarks as the detector orders them (3x21) in the model's order; NaN: unknown.
  Eigen::Matrix3Xd in_model_order(const Eigen::Matrix<double, 3, 21>& detected,
                                  Eigen::Index count) const;
};

/// Returns how a model has the detector's landmarks; nothing if it is no hand: it lacks wrist,
/// knuckles or more than half of the others, or nothing bends its fingers.
std::optional<HandModel> hand_model(const Model& model);

}  // namespace hypotrack::hands
