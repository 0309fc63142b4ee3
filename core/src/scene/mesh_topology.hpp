#pragma once

#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the mesh by which hypotheses are scored.
inline const Mesh& simplified_mesh(const Model& model) {
  const ModelData& data = model.data();
  const bool is_simplified = data.simplified.triangles.cols() > 0 && !model.poses_itself();
  return is_simplified ? data.simplified : data.mesh;
}

/// Returns true if a mesh is the outer surface of solid bodies. Then every edge joins two triangles
/// of equal orientation, and every connected part encloses a positive volume. From outside, the
/// nearest surface faces the camera, so that back faces need not be drawn.
bool is_closed_outwards(const Mesh& mesh);

/// Returns the vertex indices sorted so that neighbours have the same bones. Vectors and warps of
/// vertices then read the same matrices.
std::vector<int> order_by_bones(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack
