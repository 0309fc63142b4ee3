#pragma once

#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Vertex numbers in an order in which neighbours are held by the same bones, so that vectors and
/// warps of vertices read the same matrices.
std::vector<int> order_by_bones(const Mesh& mesh);

}  // namespace hypotrack
