#include <algorithm>

#include "tile/tiles.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the pinhole camera of a square image, `extent` wide on the plane z = 1, around a centre.
TileCamera tile_camera(int size, double extent, const Bounds& around,
                       const Eigen::Isometry3d& ideal_from_world) {
  TileCamera camera;
  camera.width = size;
  camera.height = size;
  camera.fx = size / extent;
  camera.fy = camera.fx;
  camera.cx = 0.5 * (size - 1) - camera.fx * 0.5 * (double{around.x0} + around.x1);
  camera.cy = 0.5 * (size - 1) - camera.fy * 0.5 * (double{around.y0} + around.y1);
  camera.camera_from_world = ideal_from_world;
  return camera;
}

}  // namespace

std::vector<TileCamera> crop(std::span<const Bounds> around, const IdealRig& rig, int size,
                             double padding, double largest_focal) {
  std::vector<Bounds> bounds(around.begin(), around.end());
  std::vector<double> extents;
  for (const Bounds& b : bounds) extents.push_back(std::max(b.width(), b.height()));
  if (rig.rectified) {
    // y/z agrees in both views up to rounding; equal bounds make rows and scales identical.
    bounds[0].y0 = bounds[1].y0 = std::min(bounds[0].y0, bounds[1].y0);
    bounds[0].y1 = bounds[1].y1 = std::max(bounds[0].y1, bounds[1].y1);
    extents[0] = extents[1] = std::max({extents[0], extents[1], bounds[0].height()});
  }
  std::vector<TileCamera> tiles;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double extent = std::max(extents[i] * (1 + 2 * padding), size / largest_focal);
    tiles.push_back(tile_camera(size, extent, bounds[i], rig.ideal_from_world[i]));
  }
  return tiles;
}

}  // namespace hypotrack::internal
