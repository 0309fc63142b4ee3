#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::contour {

/// A point on a model's surface with its unit normal, outwards. In the model's frame.
struct SurfacePoint {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};

/// Returns `count` points spread evenly over a mesh's surface; equal meshes give equal points.
/// Normals point outwards, also where all triangles face inwards.
std::vector<SurfacePoint> spread_points(const Mesh& mesh, int count);

}  // namespace hypotrack::contour
