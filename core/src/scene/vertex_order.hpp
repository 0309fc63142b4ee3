#pragma once

#include <vector>

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the vertex indices sorted so that neighbours have the same bones. Vectors and warps of
/// vertices then read the same matrices.
std::vector<int> order_by_bones(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack
