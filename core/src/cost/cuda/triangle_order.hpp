#pragma once

#include <vector>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the triangle indices sorted so that neighbours are close and face the same way. A warp
/// then usually finds all of its triangles visible or none.
std::vector<int> order_by_place(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack::cuda
