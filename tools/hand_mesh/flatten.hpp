#pragma once

#include <Eigen/Core>
#include <vector>

#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

/// Part of a mesh with its own vertices.
struct Chart {
  std::vector<int> vertices;          ///< mesh vertex of each of the chart's
  std::vector<int> source;            ///< mesh triangle of each of the chart's
  std::vector<Triangle> triangles;    ///< indices into `vertices`
  std::vector<Eigen::Vector2d> flat;  ///< millimetres, counter-clockwise triangles
};

/// Lays a chart that is a disc flat, as rigidly as possible: Tutte's embedding as the start, then
/// the local/global iteration of Liu et al., "A local/global approach to mesh parameterization",
/// SGP 2008. Throws std::runtime_error where the chart is no disc or triangles stay turned over.
void flatten(const TriangleMesh& mesh, Chart& chart);

}  // namespace hypotrack::hand_mesh
