#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "hypotrack/observation.hpp"
#include "hypotrack/pixel.hpp"
#include "hypotrack/view_pixels.hpp"

namespace hypotrack {

/// Returns the map from the tile of view `from` into that of view `to`.
inline StereoMap stereo_map(const Observation& observation, int from, int to) {
  const TileCamera& a = observation.views[static_cast<std::size_t>(from)].camera;
  const TileCamera& b = observation.views[static_cast<std::size_t>(to)].camera;
  const Eigen::Isometry3d b_from_a =
      b.camera_from_world * a.camera_from_world.inverse(Eigen::Isometry);
  const auto matrix = [](const TileCamera& c) {
    return (Eigen::Matrix3d() << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1).finished();
  };
  const Eigen::Vector3d t = matrix(b) * b_from_a.translation();
  Eigen::Matrix3d m;
  if (observation.rectified) {
    m.setIdentity();
    m(0, 2) = b.cx - a.cx;
  } else {
    m = matrix(b) * b_from_a.linear() * matrix(a).inverse();
  }
  StereoMap map{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) map.a[i][j] = static_cast<float>(m(i, j));
    map.b[i] = static_cast<float>(t(i));
  }
  map.width = b.width;
  map.height = b.height;
  map.rectified = observation.rectified;
  return map;
}

}  // namespace hypotrack
