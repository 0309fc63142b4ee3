#pragma once

#include "surface.hpp"
#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

inline constexpr int kVertices = 1491;

/// The hand's surface as kVertices welded vertices: fine at tips and joints, coarse on the palm.
TriangleMesh hand_shape(const HandSurface& surface);

}  // namespace hypotrack::hand_mesh
