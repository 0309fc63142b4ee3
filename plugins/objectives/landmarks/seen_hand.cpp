#include "seen_hand.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hypotrack::landmarks {

Eigen::Vector3d eye_of(const TileCamera& camera) {
  return camera.camera_from_world.inverse().translation();
}

SeenHand seen_hand(const HandDetection& detection, const TileCamera& camera) {
  SeenHand out;
  out.presence = detection.presence;
  out.right = detection.right;
  const Eigen::Matrix3d world_from_camera = camera.camera_from_world.linear().transpose();
  for (Eigen::Index i = 0; i < out.directions.cols(); ++i) {
    const Eigen::Vector2d pixel = detection.landmarks.col(i);
    const Eigen::Vector3d ray((pixel.x() - camera.cx) / camera.fx,
                              (pixel.y() - camera.cy) / camera.fy, 1);
    out.directions.col(i) = world_from_camera * ray.normalized();
  }
  const HandPoints across = detection.relative.topRows<2>();
  const double metres = (across.colwise() - across.rowwise().mean()).norm();
  const double radians = (out.directions.colwise() - out.directions.rowwise().mean()).norm();
  out.distance = metres / radians;
  return out;
}

HandPoints in_tile(const HandPoints3D& points, const TileCamera& camera) {
  HandPoints out = HandPoints::Constant(std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = camera.camera_from_world * Eigen::Vector3d(points.col(i));
    if (!(p.z() > 0)) continue;
    out.col(i) << camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy;
  }
  return out;
}

HandPoints3D directions_to(const HandPoints3D& points, const TileCamera& camera) {
  return (points.colwise() - eye_of(camera)).colwise().normalized();
}

double apparent_size(const HandPoints3D& directions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0, reach = 0;
  for (const auto& d : directions.colwise()) {
    if (!d.allFinite()) continue;
    sum += d;
    ++count;
  }
  for (const auto& d : directions.colwise()) {
    if (d.allFinite()) reach = std::max(reach, (d - sum / count).norm());
  }
  return 2 * reach;
}

double mean_angle(const HandPoints3D& a, const HandPoints3D& b) {
  double sum = 0, count = 0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double angle = std::atan2(
        Eigen::Vector3d(a.col(i)).cross(Eigen::Vector3d(b.col(i))).norm(), a.col(i).dot(b.col(i)));
    if (std::isnan(angle)) continue;
    sum += angle;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

}  // namespace hypotrack::landmarks
