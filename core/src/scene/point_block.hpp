#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "base/exported.hpp"
#include "scene/scene_poser.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// One number per vertex of a block.
using BlockArray = Eigen::Array<float, kBlock, 1>;

/// The coordinates of a block of points.
struct PointBlock {
  BlockArray x, y, z;
};

/// Returns the block of posed vertices that begins at `first`, in another camera's frame.
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

}  // namespace internal
}  // namespace hypotrack
