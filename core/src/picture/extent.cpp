#include "picture/extent.hpp"

#include <limits>

namespace hypotrack::internal {

Eigen::AlignedBox2d extent_of(std::span<const Eigen::Matrix3Xf> vertices,
                              const Eigen::Isometry3d& camera_from_world) {
  const Eigen::Isometry3f pose = camera_from_world.cast<float>();
  Eigen::AlignedBox2d box;
  bool behind = false;
  for (const Eigen::Matrix3Xf& model : vertices) {
    const Eigen::Matrix3Xf p = pose * model;
    for (Eigen::Index i = 0; i < p.cols(); ++i) {
      if (p(2, i) < 2 * kNearest) {
        behind = true;
      } else {
        box.extend((p.col(i).head<2>() / p(2, i)).cast<double>());
      }
    }
  }
  if (behind && !box.isEmpty()) {  // a triangle through the camera plane may reach anywhere
    box.min().setConstant(-std::numeric_limits<double>::infinity());
    box.max().setConstant(std::numeric_limits<double>::infinity());
  }
  return box;
}

}  // namespace hypotrack::internal
