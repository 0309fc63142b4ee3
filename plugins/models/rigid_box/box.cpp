#include "box.hpp"

namespace hypotrack {
namespace {

/// Adds the face at one end of an axis.
void add_face(Mesh& mesh, int axis, bool positive, const BoxLayout& layout) {
  // Right and up in a view of the face from outside; right x up points outwards.
  const int right = (axis + 1) % 3;
  const int up = (axis + 2) % 3;
  // Vertex number: bit 0 is the side of x, bit 1 of y, bit 2 of z.
  const auto vertex = [&](bool at_right, bool at_up) {
    const bool right_side = positive ? at_right : !at_right;
    return (positive ? 1 << axis : 0) | (right_side ? 1 << right : 0) | (at_up ? 1 << up : 0);
  };
  const Eigen::Vector4i corners(vertex(false, false), vertex(true, false), vertex(true, true),
                                vertex(false, true));
  const Eigen::Index face = 2 * axis + (positive ? 0 : 1);
  const auto first_uv = static_cast<int>(4 * face);
  mesh.triangles.col(2 * face) << corners[0], corners[1], corners[2];
  mesh.triangles.col(2 * face + 1) << corners[0], corners[2], corners[3];
  mesh.uv_triangles.col(2 * face) << first_uv, first_uv + 1, first_uv + 2;
  mesh.uv_triangles.col(2 * face + 1) << first_uv, first_uv + 2, first_uv + 3;
  const cv::Rect2d& tile = layout.faces[static_cast<std::size_t>(face)];
  const double left = tile.x / layout.image.width;
  const double right_end = (tile.x + tile.width) / layout.image.width;
  const double top = 1 - tile.y / layout.image.height;  // texture coordinates go upwards
  const double bottom = 1 - (tile.y + tile.height) / layout.image.height;
  Eigen::Matrix<double, 2, 4> uv;
  uv << left, right_end, right_end, left,  //
      bottom, bottom, top, top;
  mesh.uv.middleCols(4 * face, 4) = uv.cast<float>();
}

}  // namespace

Mesh box_mesh(const Eigen::Vector3d& size, const BoxLayout& layout) {
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
    add_face(mesh, axis, true, layout);
    add_face(mesh, axis, false, layout);
  }
  return mesh;
}

}  // namespace hypotrack
