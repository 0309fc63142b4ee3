#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/objective.hpp"
#include "hypotrack/pixel.hpp"
#include "hypotrack/unorm16.hpp"

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

}  // namespace hypotrack
