#pragma once

#include <Eigen/Core>
#include <functional>

#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

struct RemeshTarget {
  int vertices = 0;
  /// Wanted edge length at a point of the surface, up to one factor common to all points.
  std::function<double(const Eigen::Vector3d&)> edge_length;
  /// The point of the surface next to a point near it.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> project;
};

/// A mesh of exactly `target.vertices` vertices on the same surface, its triangles near equilateral
/// and of the wanted size: edges are split, collapsed and flipped towards six triangles per vertex,
/// vertices relaxed within the surface (Botsch and Kobbelt, "A remeshing approach to
/// multiresolution modeling", SGP 2004).
TriangleMesh remesh(const TriangleMesh& fine, const RemeshTarget& target);

}  // namespace hypotrack::hand_mesh
