#pragma once

#include "base/exported.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns true if a mesh is the outer surface of solid bodies. Then every edge joins two triangles
/// of equal orientation, and every connected part encloses a positive volume. From outside, the
/// nearest surface faces the camera, so that back faces need not be drawn.
bool is_closed_outwards(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack
