#pragma once

#include <cstdint>

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/plugin/pixel.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"

namespace hypotrack::cuda {

/// A pixel of the reference view ("here") and its match in the other view. Exactly one of `seen`,
/// `occluded` and `uncovered` is true.
struct StereoPixel {
  int x, y;
  float inverse_depth;  ///< here, 1/m; 0 if uncovered
  bool seen, occluded, uncovered;
  float u, v;         ///< position of the surface point in the other view, pixels; if seen
  int column, row;    ///< nearest pixel to (u, v); if seen
  int width, height;  ///< size of the other view's tile
  bool same_row;      ///< true for a rectified pair: row == y
};

/// A pixel of one view alone.
struct ViewPixel {
  int view;
  int x, y;
  float inverse_depth;  ///< 1/m; 0 if not covered
  bool covered;
};

/// Classifies pixel (x, y) of the reference tile, with inverse depth w. `there(column, row)`
/// returns the other view's inverse depth, 0 where nothing is drawn. `there.in_row(column, row)`
/// does so for a row of the reference view.
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
