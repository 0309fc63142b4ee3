#pragma once

#include <cstdint>

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/pixel.hpp"
#include "hypotrack/stereo_pixels_map-inl.hpp"

namespace hypotrack::cuda {

/// A pixel of the reference view and what it sees in the other one. Exactly one of `seen`,
/// `occluded` and `uncovered` is true.
struct StereoPixel {
  int x, y;
  float inverse_depth;  ///< here, 1/m; 0 where uncovered
  bool seen, occluded, uncovered;
  float u, v;         ///< where the surface point is in the other view, pixels; if seen
  int column, row;    ///< the same, the nearest pixel; if seen
  int width, height;  ///< of the other view's tile
  bool same_row;      ///< rectified: row == y
};

/// A pixel of one view by itself.
struct ViewPixel {
  int view;
  int x, y;
  float inverse_depth;  ///< 1/m; 0 where not covered
  bool covered;
};

/// What the pixel (x, y) of the reference tile with inverse depth w sees. `there(column, row)` is
/// the inverse depth in the other view, 0 where nothing is drawn; there.in_row(column, row) the
/// same for a row of the reference view's pixels.
template <bool kRectified, class Depth>
__device__ __forceinline__ StereoPixel stereo_pixel(const StereoMap& map, float tolerance, int x,
                                                    int y, float w, const Depth& there) {
  StereoPixel p{};
  p.x = x;
  p.y = y;
  p.inverse_depth = w;
  p.width = map.width;
  p.height = map.height;
  p.same_row = kRectified;
  p.uncovered = !(w > 0.0f);
  if (p.uncovered) return p;
  const auto m = scalar::map_pixel<kRectified, float>(map, exact_float(x), exact_float(y), w);
  p.u = m.u;
  p.v = m.v;
  if (scalar::lands_inside<kRectified>(map, m)) {
    p.column = round_nearest(m.u);
    p.row = kRectified ? y : round_nearest(m.v);
    const float w_there = kRectified ? there.in_row(p.column, y) : there(p.column, p.row);
    p.seen = scalar::same_depth(m.inverse_depth, w_there, tolerance);
  }
  p.occluded = !p.seen;
  return p;
}

}  // namespace hypotrack::cuda
