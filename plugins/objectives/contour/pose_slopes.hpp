#pragma once

#include <Eigen/Geometry>
#include <span>

namespace hypotrack::contour {

/// Returns the derivatives of R(q) x by the components w, x, y, z of a unit quaternion.
inline Eigen::Matrix<double, 3, 4> quaternion_slopes(std::span<const double, 4> q,
                                                     const Eigen::Vector3d& x) {
  const double w = q[0];
  const Eigen::Vector3d v(q[1], q[2], q[3]);
  Eigen::Matrix3d cross;
  cross << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
  Eigen::Matrix<double, 3, 4> out;
  out.col(0) = 2 * (w * x + v.cross(x));
  out.rightCols<3>() = 2 * (v.dot(x) * Eigen::Matrix3d::Identity() + v * x.transpose() -
                            x * v.transpose() - w * cross);
  return out;
}

}  // namespace hypotrack::contour
