#pragma once

#include <vector>

#include "flatten.hpp"

namespace hypotrack::hand_mesh {

/// Turns and moves flat charts into the unit square without overlaps, a gap of two cells of a
/// 200 x 200 grid between any two. All keep the same scale, which is returned: units per
/// millimetre.
double pack(std::vector<Chart>& charts);

}  // namespace hypotrack::hand_mesh
