#include <Eigen/LU>
#include <limits>

#include "camera/epipolar_line.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {

Eigen::Vector3d triangulate(const Camera& a, const Eigen::Vector2d& in_a, const Camera& b,
                            const Eigen::Vector2d& in_b) {
  constexpr double kParallel = 1e-12;
  const Eigen::Isometry3d world_from_a = a.camera_from_world.inverse();
  const Eigen::Isometry3d world_from_b = b.camera_from_world.inverse();
  const Eigen::Vector3d u = world_from_a.linear() * back_project(a, in_a);
  const Eigen::Vector3d v = world_from_b.linear() * back_project(b, in_b);
  // Depths s and t of the two nearest points: least squares of |a + s u - b - t v|.
  Eigen::Matrix2d normal;
  normal << u.dot(u), -u.dot(v), -u.dot(v), v.dot(v);
  const Eigen::Vector3d apart = world_from_b.translation() - world_from_a.translation();
  const Eigen::Vector2d depths = normal.inverse() * Eigen::Vector2d(u.dot(apart), -v.dot(apart));
  if (!(normal.determinant() > kParallel) || !(depths.minCoeff() > 0))
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return (world_from_a.translation() + depths[0] * u + world_from_b.translation() + depths[1] * v) /
         2;
}

}  // namespace hypotrack::internal
