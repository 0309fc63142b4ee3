#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// Points of a surface. Each lies in a triangle: the sum of its corners, weighted.
struct SurfacePoints {
  Eigen::Matrix3Xi corners;  ///< vertices
  Eigen::Matrix3Xf weights;  ///< barycentric coordinates

  Eigen::Index count() const { return corners.cols(); }
};

/// Spreads points evenly over the area of a mesh. None where it has no area.
HYPOTRACK_API SurfacePoints spread_points(const Mesh& mesh, Eigen::Index count);

/// Positions of the points with the mesh's vertices at `vertices` (3xV), 3xN.
HYPOTRACK_API Eigen::Matrix3Xf positions(const SurfacePoints& points,
                                         const Eigen::Matrix3Xf& vertices);

}  // namespace hypotrack
