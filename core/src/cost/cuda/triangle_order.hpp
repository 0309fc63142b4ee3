#pragma once

#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack::cuda {

/// Returns the triangle indices sorted so that neighbours are close and face the same way. A warp
/// then usually finds all of its triangles visible or none.
std::vector<int> order_by_place(const Mesh& mesh);

}  // namespace hypotrack::cuda
