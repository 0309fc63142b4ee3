#pragma once

#include <Eigen/Core>
#include <functional>

#include "triangle_mesh.hpp"

namespace hypotrack::hand_mesh {

/// The surface where `field` is zero, by marching tetrahedra over the cells (edge length `cell`) of
/// the box from `low` to `high`: closed and manifold as long as it stays inside of the box.
TriangleMesh extract_surface(const std::function<double(const Eigen::Vector3d&)>& field,
                             const Eigen::Vector3d& low, const Eigen::Vector3d& high, double cell);

}  // namespace hypotrack::hand_mesh
