#include "geometry/crop.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "evaluate/point_block.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr float kNearest = 1e-3f;  // metres in front of a camera that everything must be

/// Lowest and highest numbers of the blocks that were added.
struct Range {
  BlockArray low = BlockArray::Constant(std::numeric_limits<float>::infinity());
  BlockArray high = -low;

  void add(const BlockArray& values) {
    low = low.min(values);
    high = high.max(values);
  }
};

void extend(Bounds& bounds, const ScenePoser& poser, const ScenePlan::Part& part,
            const Eigen::Matrix<float, 3, 4>& ideal_from_first, std::size_t view) {
  Range x, y, z;
  BlockArray poison = BlockArray::Zero();  // NaN once anything is not finite
  for (std::size_t i = 0; i < part.vertex_count; i += kBlock) {
    const PointBlock p = point_block(poser, part.first_vertex + i, ideal_from_first);
    x.add(p.x / p.z);
    y.add(p.y / p.z);
    z.add(p.z);
    poison += 0.0f * (p.x + p.y + p.z);
  }
  const float nearest = z.low.minCoeff();
  if (!(poison == 0.0f).all() || nearest < kNearest) {
    throw DataError(
        fmt::format("model '{}' lies at or behind camera {} (nearest vertex at z = {:.3g} m); "
                    "expected a pose in front of every camera",
                    part.item->name, view, nearest));
  }
  bounds.x0 = std::min(bounds.x0, x.low.minCoeff());
  bounds.x1 = std::max(bounds.x1, x.high.maxCoeff());
  bounds.y0 = std::min(bounds.y0, y.low.minCoeff());
  bounds.y1 = std::max(bounds.y1, y.high.maxCoeff());
}

/// The pinhole camera whose square image is `extent` wide on the plane z = 1 around a centre.
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

SceneBounds::SceneBounds(const Scene& scene, const IdealRig& rig)
    : scene_(scene), plan_(scene), poser_(plan_), first_from_world_(rig.ideal_from_world.at(0)) {
  for (const Eigen::Isometry3d& ideal_from_world : rig.ideal_from_world) {
    const Eigen::Isometry3d ideal_from_first = ideal_from_world * first_from_world_.inverse();
    ideal_from_first_.emplace_back(ideal_from_first.matrix().topRows<3>().cast<float>());
  }
}

std::vector<Bounds> SceneBounds::of(const Eigen::VectorXd& state) {
  state_ = state;
  scene_.normalize(state_);
  poser_.pose({state_.data(), static_cast<std::size_t>(state_.size())}, first_from_world_);
  std::vector<Bounds> all(ideal_from_first_.size());
  for (const ScenePlan::Part& part : plan_.parts) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      extend(all[i], poser_, part, ideal_from_first_[i], i);
    }
  }
  return all;
}

std::vector<TileCamera> crop(std::vector<Bounds> bounds, const IdealRig& rig, int size,
                             double padding, double largest_focal) {
  std::vector<double> extents;
  for (const Bounds& b : bounds) extents.push_back(std::max(b.width(), b.height()));
  if (rig.rectified) {
    // y/z agrees in both views up to rounding; the same bounds make rows and scales identical.
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

}  // namespace hypotrack
