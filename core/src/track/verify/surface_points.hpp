#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/types.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Points on a mesh, each a weighted sum of its triangle's corners.
struct SurfacePoints {
  Eigen::Matrix3Xi corners;   ///< vertex indices
  Eigen::Matrix3Xf weights;   ///< barycentric coordinates
  Eigen::VectorXi triangles;  ///< the triangle of each point
  double area = 0;            ///< of the mesh, square metres

  Eigen::Index count() const { return corners.cols(); }
};

/// Spreads points evenly over the area of a mesh. Returns none if it has no area.
SurfacePoints spread_points(const Mesh& mesh, Eigen::Index count);

/// Returns a mesh of the vertices that are corners of points alone, without triangles; numbers the
/// points' corners anew.
Mesh take_corners(const Mesh& mesh, SurfacePoints& points);

/// Returns the positions (3xN) of the points with the mesh's vertices at `vertices` (3xV).
Eigen::Matrix3Xf positions(const SurfacePoints& points, const Eigen::Matrix3Xf& vertices);

/// Returns the colours (B, G, R, 0 .. 255) of a mesh's texture at its points, each the mean over a
/// square of `side` metres. Returns none without a texture.
std::vector<cv::Vec3f> texture_colors(const Mesh& mesh, const SurfacePoints& points, double side);

/// Returns the motions of a mesh, other than the identity, that put its surface onto itself. Tries
/// quarter and half turns about its axes of inertia and those of its file.
std::vector<Eigen::Isometry3d> symmetries(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack
