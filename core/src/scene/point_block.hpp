#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "scene/scene_poser.hpp"

namespace hypotrack {

/// One number for each of a block's vertices.
using BlockArray = Eigen::Array<float, kBlock, 1>;

/// A block of points.
struct PointBlock {
  BlockArray x, y, z;
};

/// The block of posed vertices that begins at `first`, seen by another camera.
inline PointBlock point_block(const ScenePoser& poser, std::size_t first,
                              const Eigen::Matrix<float, 3, 4>& other_from_camera) {
  using Vertices = Eigen::Map<const BlockArray, Eigen::Aligned64>;
  const Vertices x(poser.x() + first);
  const Vertices y(poser.y() + first);
  const Vertices z(poser.z() + first);
  const auto& m = other_from_camera;
  return {m(0, 0) * x + m(0, 1) * y + m(0, 2) * z + m(0, 3),
          m(1, 0) * x + m(1, 1) * y + m(1, 2) * z + m(1, 3),
          m(2, 0) * x + m(2, 1) * y + m(2, 2) * z + m(2, 3)};
}

}  // namespace hypotrack
