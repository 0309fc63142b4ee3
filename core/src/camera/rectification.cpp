#include "camera/rectification.hpp"

#include <cmath>
#include <optional>

namespace hypotrack::internal {
namespace {

/// Returns rectified_from_world of a pair, or nothing if it is not near-parallel.
std::optional<Eigen::Matrix3d> rectifying_rotation(const Camera& a, const Camera& b) {
  const Eigen::Matrix3d world_from_a = a.camera_from_world.linear().transpose();
  const Eigen::Matrix3d world_from_b = b.camera_from_world.linear().transpose();
  const Eigen::Vector3d centre_a = -world_from_a * a.camera_from_world.translation();
  const Eigen::Vector3d centre_b = -world_from_b * b.camera_from_world.translation();
  const Eigen::Vector3d baseline = centre_b - centre_a;
  if (baseline.norm() < kShortestBaseline) return std::nullopt;

  const Eigen::Vector3d axis_a = world_from_a.col(2);
  const Eigen::Vector3d axis_b = world_from_b.col(2);
  const Eigen::Vector3d x = baseline.normalized();
  const Eigen::Vector3d mean = axis_a + axis_b;
  const Eigen::Vector3d forward = mean - x.dot(mean) * x;
  if (forward.norm() < 1e-6) return std::nullopt;
  const Eigen::Vector3d z = forward.normalized();
  const double least = std::cos(kRectifyLimit);
  if (axis_a.dot(z) < least || axis_b.dot(z) < least) return std::nullopt;

  Eigen::Matrix3d rotation;
  rotation.row(0) = x;
  rotation.row(1) = z.cross(x);
  rotation.row(2) = z;
  return rotation;
}

}  // namespace

IdealRig make_ideal_rig(std::span<const Camera> cameras) {
  IdealRig rig;
  std::optional<Eigen::Matrix3d> shared;
  if (cameras.size() == 2) shared = rectifying_rotation(cameras[0], cameras[1]);
  rig.rectified = shared.has_value();
  for (const Camera& camera : cameras) {
    const Eigen::Matrix3d camera_from_world = camera.camera_from_world.linear();
    const Eigen::Matrix3d ideal_from_world = shared.value_or(camera_from_world);
    const Eigen::Matrix3d ideal_from_camera = ideal_from_world * camera_from_world.transpose();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = ideal_from_world;
    pose.translation() = ideal_from_camera * camera.camera_from_world.translation();
    rig.ideal_from_world.push_back(pose);
    rig.camera_from_ideal.push_back(ideal_from_camera.transpose());
  }
  return rig;
}

}  // namespace hypotrack::internal
