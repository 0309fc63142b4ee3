#pragma once

#include <Eigen/Core>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// Points on a mesh, each a weighted sum of its triangle's corners.
struct SurfacePoints {
  Eigen::Matrix3Xi corners;  ///< vertex indices
  Eigen::Matrix3Xf weights;  ///< barycentric coordinates

  Eigen::Index count() const { return corners.cols(); }
};

/// Spreads points evenly over the area of a mesh. Returns none if it has no area.
SurfacePoints spread_points(const Mesh& mesh, Eigen::Index count);

/// Returns the positions (3xN) of the points with the mesh's vertices at `vertices` (3xV).
Eigen::Matrix3Xf positions(const SurfacePoints& points, const Eigen::Matrix3Xf& vertices);

}  // namespace hypotrack
