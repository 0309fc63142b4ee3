#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Proportions of a hand, relative to its mesh.
struct HandShape {
  double scale = 1;
  std::array<double, 5> lengths = {1, 1, 1, 1, 1};  ///< thumb, index, middle, ring, little
  double width = 1;                                 ///< width of all fingers
};

/// Returns the shape parameters of a hand: scale, thumb, index, middle, ring, little, width; all
/// neutral.
const std::vector<ShapeParameter>& hand_shape_parameters();

/// Converts values of the shape parameters to a shape.
HandShape hand_shape(std::span<const double> values);

/// Changes the shape of a hand. Stretches every bone of a finger along and across, from its first
/// joint on (the thumb: from the CMC), with its flesh and landmarks. The palm keeps its
/// proportions.
void build(ModelData& hand, const HandShape& shape);

/// Converts a scene's `finger_scale` to lengths. It has no number (no change), one for all fingers,
/// or five: thumb, index, middle, ring, little. Throws ConfigError, naming `where`, on another
/// count.
std::array<double, 5> finger_lengths(const std::vector<double>& factors, const std::string& where);

}  // namespace hypotrack
