#pragma once

#include <array>
#include <vector>

#include "hand_asset.hpp"

namespace hypotrack::hand_mesh {

using DigitAngles = std::array<std::array<double, 4>, kDigits>;

/// The hand, made once per program, with the texture of the committed file.
const HandAsset& the_hand();

/// Abduction and three flexions per digit, degrees, thumb first.
DigitAngles in_radians(DigitAngles degrees);
DigitAngles bind_angles();
DigitAngles flat_angles();
DigitAngles fist_angles();
DigitAngles pinch_angles();

/// The hand's vertices in a pose.
std::vector<Eigen::Vector3d> posed(const DigitAngles& angles);

double volume(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& vertices);

}  // namespace hypotrack::hand_mesh
