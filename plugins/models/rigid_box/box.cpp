#include "box.hpp"

namespace hypotrack {
namespace {

/// Adds the face at one end of an axis.
void add_face(Mesh& mesh, int axis, bool positive, Eigen::Index face) {
  // Right and up as one looks at the face from outside; right x up points outwards.
  const int right = (axis + 1) % 3;
  const int up = (axis + 2) % 3;
  // Vertex number: bit 0 is the side of x, bit 1 of y, bit 2 of z.
  const auto vertex = [&](bool at_right, bool at_up) {
    const bool right_end = positive ? at_right : !at_right;
    return (positive ? 1 << axis : 0) | (right_end ? 1 << right : 0) | (at_up ? 1 << up : 0);
  };
  const Eigen::Vector4i corners(vertex(false, false), vertex(true, false), vertex(true, true),
                                vertex(false, true));
  const auto first_uv = static_cast<int>(4 * face);
  mesh.triangles.col(2 * face) << corners[0], corners[1], corners[2];
  mesh.triangles.col(2 * face + 1) << corners[0], corners[2], corners[3];
  mesh.uv_triangles.col(2 * face) << first_uv, first_uv + 1, first_uv + 2;
  mesh.uv_triangles.col(2 * face + 1) << first_uv, first_uv + 2, first_uv + 3;
  const Eigen::Array2f tile(1.0f / kBoxColumns, 1.0f / kBoxRows);
  const Eigen::Array2f origin(static_cast<float>(axis), positive ? 1.0f : 0.0f);
  constexpr std::array<std::array<float, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  // The rim of a tile stays unused, so that filtering does not mix neighbouring faces.
  constexpr float kRim = 0.002f;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Array2f corner =
        Eigen::Array2f(kCorner[k][0], kCorner[k][1]) * (1 - 2 * kRim) + kRim;
    mesh.uv.col(4 * face + static_cast<Eigen::Index>(k)) = ((origin + corner) * tile).matrix();
  }
}

}  // namespace

Mesh box_mesh(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int v = 0; v < 8; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      mesh.vertices(axis, v) =
          static_cast<float>((v >> axis & 1) ? size[axis] / 2 : -size[axis] / 2);
    }
  }
  mesh.triangles.resize(3, 12);
  mesh.uv_triangles.resize(3, 12);
  mesh.uv.resize(2, 24);
  for (int axis = 0; axis < 3; ++axis) {
    add_face(mesh, axis, true, 2 * axis);
    add_face(mesh, axis, false, 2 * axis + 1);
  }
  return mesh;
}

}  // namespace hypotrack
