#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack {

/// One feature per pixel of a tile. Rows have no gaps; padding after the last row fits a whole SIMD
/// vector. T is float or std::uint32_t (for example two 16-bit features).
template <class T>
class PixelPlane {
 public:
  static_assert(sizeof(T) == 4, "SIMD lanes are 32 bits wide");

  PixelPlane() = default;
  /// Creates a plane of zeros.
  PixelPlane(int width, int height) { resize(width, height); }

  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    data_.assign(static_cast<std::size_t>(width) * height + kPadding, T{});
  }
  int width() const { return width_; }
  int height() const { return height_; }
  T* row(int y) { return data_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const T* row(int y) const { return data_.data() + static_cast<std::ptrdiff_t>(y) * width_; }

 private:
  static constexpr std::size_t kPadding = 64;
  int width_ = 0;
  int height_ = 0;
  std::vector<T> data_;
};

/// A box of pixels: x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Returns the part of a tile that a hypothesis may cover.
inline PixelBox covered_box(const DepthTile& tile) { return {tile.x0, tile.y0, tile.x1, tile.y1}; }
/// Returns the box of the whole tile.
inline PixelBox whole_tile(const DepthTile& tile) { return {0, 0, tile.width, tile.height}; }

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
