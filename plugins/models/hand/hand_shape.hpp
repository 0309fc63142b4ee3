#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// How a hand is built, relative to its mesh.
struct HandShape {
  double scale = 1;
  std::array<double, 5> lengths = {1, 1, 1, 1, 1};  ///< thumb, index, middle, ring, little
  double width = 1;                                 ///< of all fingers, across
};

/// The shape parameters of a hand: scale, thumb, index, middle, ring, little, width; all neutral.
const std::vector<ShapeParameter>& hand_shape_parameters();

/// Their values as a shape.
HandShape hand_shape(std::span<const double> values);

/// Builds a hand otherwise. Every bone of a finger, from its first joint on (the thumb: from the
/// CMC), is stretched along and across itself with the flesh and the landmarks on it; the palm
/// keeps its proportions.
void build(ModelData& hand, const HandShape& shape);

/// Lengths from what a scene gives as `finger_scale`: nothing (no change), one number for all
/// fingers, or five: thumb, index, middle, ring, little. Throws ConfigError, naming `where`, on
/// another count.
std::array<double, 5> finger_lengths(const std::vector<double>& factors, const std::string& where);

}  // namespace hypotrack
