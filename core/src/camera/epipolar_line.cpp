#include "camera/epipolar_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {
namespace {

double distance_from_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

}  // namespace

Eigen::Vector2d project_uniquely(const Camera& camera, const Eigen::Vector3d& p_world) {
  constexpr double kSame = 1e-3;  // at depth 1
  const Eigen::Vector2d pixel = project(camera, p_world);
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (!pixel.allFinite()) return none;
  const Eigen::Vector3d seen = camera.camera_from_world * p_world;
  const Eigen::Vector3d ray = back_project(camera, pixel);
  const double away = (ray.head<2>() - seen.head<2>() / seen.z()).norm();
  return away < kSame * std::max(1.0, ray.norm()) ? pixel : none;
}

Eigen::Matrix2Xd epipolar_line(const Camera& camera, const Eigen::Vector2d& pixel,
                               const Camera& other) {
  constexpr Eigen::Index kSamples = 257;
  constexpr double kNearest = 0.05, kInfinite = 1e6;  // metres
  const Eigen::Vector3d ray = back_project(camera, pixel);
  if (!ray.allFinite()) return {};
  const Eigen::Isometry3d world_from_camera = camera.camera_from_world.inverse();
  Eigen::Matrix2Xd line(2, kSamples);
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const double inverse =
        static_cast<double>(i) / (kSamples - 1) / kNearest + (i == 0 ? 1 / kInfinite : 0.0);
    line.col(i) = project_uniquely(other, world_from_camera * (ray / inverse));
  }
  return line;
}

double distance_from_line(const Eigen::Matrix2Xd& line, const Eigen::Vector2d& pixel) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 1; i < line.cols(); ++i) {
    if (!line.col(i - 1).allFinite() || !line.col(i).allFinite()) continue;
    nearest = std::min(nearest, distance_from_segment(line.col(i - 1), line.col(i), pixel));
  }
  return nearest;
}

}  // namespace hypotrack::internal
