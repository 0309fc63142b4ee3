#pragma once

#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::test {

/// Returns two cameras of 640 x 480 pixels side by side. `baseline`: in metres.
inline std::vector<Camera> camera_pair(double baseline) {
  Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
  camera.camera_from_world = Eigen::Isometry3d::Identity();
  std::vector<Camera> cameras(2, camera);
  cameras[1].camera_from_world.translation().x() = -baseline;
  return cameras;
}

}  // namespace hypotrack::test
