#pragma once

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Returns true if a mesh is the outer surface of solid bodies. Then every edge joins two triangles
/// of equal orientation, and every connected part encloses a positive volume. From outside, the
/// nearest surface faces the camera, so that back faces need not be drawn.
bool is_closed_outwards(const Mesh& mesh);

}  // namespace hypotrack
