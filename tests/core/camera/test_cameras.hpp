#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::test {

/// A plausible camera with a lens of each kind: 0 pinhole, 4, 5, 8, 12, 14 coefficients, -4
/// fisheye.
inline Camera lens_camera(int coefficients) {
  Camera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.fx = 703.25;
  camera.fy = 701.5;
  camera.cx = 644.3;
  camera.cy = 352.8;
  const std::vector<double> brown = {-0.28,  0.09,   0.0012,  -0.0007, -0.012, 0.02,  0.011,
                                     -0.004, 0.0006, -0.0002, -0.0004, 0.0001, 0.012, -0.02};
  if (coefficients > 0) {
    camera.distortion_model = DistortionModel::brown;
    camera.distortion.assign(brown.begin(), brown.begin() + coefficients);
  } else if (coefficients < 0) {
    camera.distortion_model = DistortionModel::fisheye;
    camera.distortion = {-0.02, 0.011, -0.006, 0.0013};
  }
  return camera;
}

inline Eigen::Isometry3d pose(const Eigen::Vector3d& rotation_vector, const Eigen::Vector3d& t) {
  Eigen::Isometry3d p = Eigen::Isometry3d::Identity();
  const double angle = rotation_vector.norm();
  if (angle > 0) p.linear() = Eigen::AngleAxisd(angle, rotation_vector / angle).matrix();
  p.translation() = t;
  return p;
}

}  // namespace hypotrack::test
