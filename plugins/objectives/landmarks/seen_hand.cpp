#include "seen_hand.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
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

HandPoints in_tile(const SeenHand& hand, const TileCamera& camera) {
  return in_tile(HandPoints3D(hand.directions.colwise() + eye_of(camera)), camera);
}

HandPoints moved(const HandPoints& hand, const HandPoints& from, const HandPoints& to) {
  using Complex = std::complex<double>;
  const auto point = [](const HandPoints& points, Eigen::Index i) {
    return Complex(points(0, i), points(1, i));
  };
  Complex from_sum = 0, to_sum = 0;
  double count = 0;
  for (Eigen::Index i = 0; i < hand.cols(); ++i) {
    if (!from.col(i).allFinite() || !to.col(i).allFinite()) continue;
    from_sum += point(from, i);
    to_sum += point(to, i);
    ++count;
  }
  const Complex from_center = from_sum / count, to_center = to_sum / count;
  Complex product = 0;
  double square = 0;
  for (Eigen::Index i = 0; i < hand.cols(); ++i) {
    if (!from.col(i).allFinite() || !to.col(i).allFinite()) continue;
    const Complex arm = point(from, i) - from_center;
    product += std::conj(arm) * (point(to, i) - to_center);
    square += std::norm(arm);
  }
  // The least-squares similarity of the plane: a factor, complex as it turns, and a shift.
  const Complex factor = product / square;
  HandPoints out;
  for (Eigen::Index i = 0; i < hand.cols(); ++i) {
    const Complex p = to_center + factor * (point(hand, i) - from_center);
    out.col(i) << p.real(), p.imag();
  }
  return out;
}

HandPoints3D directions_to(const HandPoints3D& points, const TileCamera& camera) {
  return (points.colwise() - eye_of(camera)).colwise().normalized();
}

Eigen::Vector3d center_of(const HandPoints3D& directions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const auto& d : directions.colwise()) {
    if (!d.allFinite()) continue;
    sum += d;
    ++count;
  }
  return sum / count;
}

double apparent_size(const HandPoints3D& directions) {
  const Eigen::Vector3d center = center_of(directions);
  double reach = 0;
  for (const auto& d : directions.colwise()) {
    if (d.allFinite()) reach = std::max(reach, (d - center).norm());
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
