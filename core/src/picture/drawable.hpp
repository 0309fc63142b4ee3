#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "gl/gl_objects.hpp"
#include "hypotrack/plugin/model.hpp"
#include "picture/shading_mesh.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The OpenGL objects of a model.
struct Drawable {
  ShadingMesh mesh;
  gl::VertexArray vertex_array;
  gl::Buffer positions;
  gl::Buffer normals;
  gl::Buffer uv;
  gl::Buffer triangles;
  gl::Texture texture;  // 0 = none
  Eigen::Vector3f color;
};

/// Uploads a mesh and its texture; pose_drawable() uploads positions and normals.
Drawable make_drawable(const Mesh& mesh);

/// Uploads the positions and normals of posed vertices (3xV, world).
void pose_drawable(const Drawable& drawable, const Eigen::Matrix3Xf& vertices);

}  // namespace internal
}  // namespace hypotrack
