#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::gltf {

/// A mesh as glTF has it: a vertex has one normal and one texture coordinate.
struct DrawnMesh {
  std::vector<int> vertices;             ///< of the model, by vertex of this mesh
  Eigen::Matrix3Xf normals;              ///< unit length, at the bind pose
  Eigen::Matrix2Xf uv;                   ///< v downwards; 2x0 without texture coordinates
  std::vector<std::uint32_t> triangles;  ///< three vertices of this mesh each
};

/// Splits the vertices of a mesh at texture seams and at edges sharper than 45 degrees.
DrawnMesh drawn_mesh(const Mesh& mesh);

}  // namespace hypotrack::gltf
