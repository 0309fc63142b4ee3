#pragma once

#include <Eigen/Core>

#include "gl/gl_objects.hpp"
#include "hypotrack/model.hpp"
#include "picture/shading_mesh.hpp"

namespace hypotrack {

/// A model on the OpenGL side.
struct Drawable {
  ShadingMesh mesh;
  gl::VertexArray vertex_array;
  gl::Buffer positions;
  gl::Buffer normals;
  gl::Buffer uv;
  gl::Buffer triangles;
  gl::Texture texture;  // 0: none
  Eigen::Vector3f color;
};

/// Puts a mesh and its texture into buffers; positions and normals follow with pose_drawable().
Drawable make_drawable(const Mesh& mesh);

/// Moves a model to where its vertices (3xV, world) are.
void pose_drawable(const Drawable& drawable, const Eigen::Matrix3Xf& vertices);

}  // namespace hypotrack
