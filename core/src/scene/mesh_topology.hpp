#pragma once

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// Whether a mesh is the outside of solid bodies: every edge joins two triangles of the same
/// orientation, and every connected part encloses a positive volume. What is nearest to a camera
/// outside then faces it, so that the other triangles need not be drawn.
HYPOTRACK_API bool is_closed_outwards(const Mesh& mesh);

}  // namespace hypotrack
