#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hypotrack::hand_mesh {

using Triangle = std::array<int, 3>;

/// A closed surface, millimetres, triangles counter-clockwise from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

}  // namespace hypotrack::hand_mesh
