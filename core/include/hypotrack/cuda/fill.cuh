#pragma once

#include "hypotrack/cuda/cull.cuh"

/// Drawing into z-buffers by a block of threads.
/// The same geometry and the same rules as the CPU's kernels
/// (core/src/evaluate/{skin,raster}_kernel.cpp), so that the same pixels are covered.
namespace hypotrack::cuda {

/// Edges are inclusive by this share of a triangle's height, so that no pixel falls between two.
inline constexpr float kInclusive = 1e-5f;

/// Barycentric coordinates of corners a and b as planes over the pixels from (x0, y0), and 1/z.
struct Planes {
  int x0, x1, y0;
  float a, a_dx, a_dy, b, b_dx, b_dy;
  float w_c, w_ac, w_bc;
};

__device__ __forceinline__ Planes make_planes(const Corners& t, int width, int first_row) {
  Planes p;
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  p.x0 = columns.first;
  p.x1 = columns.last;
  p.y0 = first_row;
  // Coordinates from the first pixel are small, so that their products are exact enough.
  const float x = exact_float(p.x0), y = exact_float(p.y0);
  const Corners s = {t.ax - x, t.ay - y, t.aw, t.bx - x, t.by - y, t.bw, t.cx - x, t.cy - y, t.cw};
  const float inverse_area = reciprocal(twice_area(s));
  p.a = (s.bx * s.cy - s.cx * s.by) * inverse_area;
  p.a_dx = (s.by - s.cy) * inverse_area;
  p.a_dy = (s.cx - s.bx) * inverse_area;
  p.b = (s.cx * s.ay - s.ax * s.cy) * inverse_area;
  p.b_dx = (s.cy - s.ay) * inverse_area;
  p.b_dy = (s.ax - s.cx) * inverse_area;
  p.w_c = t.cw;
  p.w_ac = t.aw - t.cw;
  p.w_bc = t.bw - t.cw;
  return p;
}

/// Writes a pixel: the larger 1/z wins, whoever comes first.
template <bool kShared>
__device__ __forceinline__ void put(const Floats<kShared>& depth, int index, float w) {
  // Positive floats order as integers.
  atomicMax(reinterpret_cast<int*>(depth.at(index)), __float_as_int(w));
}

/// Where an edge crosses the rows: x = at + dy * per_row, in pixels from Planes::x0. What lies
/// within is to the right of it, or to the left.
struct Crossing {
  float at, per_row;
  bool right;

  /// Of the edge where a + dx * a_dx + dy * a_dy = 0, a little widened.
  __device__ __forceinline__ Crossing(float a, float a_dx, float a_dy) {
    constexpr float kHorizontal = 1e-20f;  // keeps the slopes of horizontal edges from being zero
    const float slope = a_dx == 0.0f ? kHorizontal : a_dx;
    const float inverse = -reciprocal(slope);
    at = (a + kInclusive) * inverse;
    per_row = a_dy * inverse;
    right = slope > 0.0f;
  }
  /// Cuts the part within the edge out of first .. last.
  __device__ __forceinline__ void cut(float dy, float& first, float& last) const {
    const float x = fmaf(dy, per_row, at);
    if (right) {
      first = fmaxf(first, x);
    } else {
      last = fminf(last, x);
    }
  }
};

/// Draws a triangle of few pixels with each thread of a warp: what of every row lies within all
/// three edges. The threads wait for each other after every row: left alone, they would run ahead
/// into their next rows one by one, at a fraction of a warp's width.
template <bool kShared>
__device__ __forceinline__ void fill_few(const Planes& p, Span rows,
                                         const DepthBuffer<kShared>& buffer) {
  const Crossing a(p.a, p.a_dx, p.a_dy), b(p.b, p.b_dx, p.b_dy);
  const Crossing c(1.0f - p.a - p.b, -(p.a_dx + p.b_dx), -(p.a_dy + p.b_dy));
  const float w_dx = fmaf(p.a_dx, p.w_ac, p.b_dx * p.w_bc);
  const float w_dy = fmaf(p.a_dy, p.w_ac, p.b_dy * p.w_bc);
  const float w_first = fmaf(p.a, p.w_ac, fmaf(p.b, p.w_bc, p.w_c));
  const float last_column = exact_float(p.x1 - p.x0);
  float dy = exact_float(rows.first - p.y0);
  int row = buffer.index(p.x0, rows.first);
  const int count = rows.last - rows.first + 1, most = warp_max(count);
#pragma unroll 1
  for (int y = 0; y < most; ++y) {
    float first = 0.0f, last = last_column;
    a.cut(dy, first, last);
    b.cut(dy, first, last);
    c.cut(dy, first, last);
    // At most one column beyond either end: a thin triangle's edges may meet far away.
    const int begin = round_up(fminf(first, last_column + 1.0f));
    const int end = y < count ? round_down(fmaxf(last, -1.0f)) : -1;
    float w = fmaf(exact_float(begin), w_dx, fmaf(dy, w_dy, w_first));
#pragma unroll 1  // one or two pixels in most rows
    for (int i = row + begin; i <= row + end; ++i, w += w_dx) put(buffer.inverse_depth, i, w);
    dy += 1.0f;
    row += buffer.box.width();
    __syncwarp();
  }
}

/// Draws a triangle of many pixels with a warp.
template <bool kShared>
__device__ __forceinline__ void fill_many(const Planes& p, Span rows,
                                          const DepthBuffer<kShared>& buffer) {
  constexpr int kWide = 8, kHigh = kWarp / kWide;  // pixels that the warp draws together
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int y = rows.first + lane / kWide; y <= rows.last; y += kHigh) {
    const float dy = exact_float(y - p.y0);
    const float row_a = fmaf(dy, p.a_dy, p.a), row_b = fmaf(dy, p.b_dy, p.b);
    for (int x = p.x0 + lane % kWide; x <= p.x1; x += kWide) {
      const float dx = exact_float(x - p.x0);
      const float a = fmaf(dx, p.a_dx, row_a), b = fmaf(dx, p.b_dx, row_b);
      if (least(a, b, 1.0f - a - b) < -kInclusive) continue;
      put(buffer.inverse_depth, buffer.index(x, y), fmaf(a, p.w_ac, fmaf(b, p.w_bc, p.w_c)));
    }
  }
}

/// Draws listed triangles into the z-buffers of one view or of a pair.
template <bool kPair, bool kSharedVertices, bool kSharedDepth>
struct Filler {
  const Staged<PackedTriangle>& triangles;
  const Vertices<kSharedVertices>& vertices;
  int width, width2, height;  ///< of the views
  const DepthBuffer<kSharedDepth>& left;
  const DepthBuffer<kSharedDepth>& right;

  /// draw(planes, rows, z-buffer) for an entry of a VisibleList.
  template <class Draw>
  __device__ __forceinline__ void prepared(int entry, const Draw& draw) const {
    const bool second = kPair && entry % 2 != 0;
    const TriangleCorners corners(triangles[entry / 2]);
    const Corners t = load_corners(corners, vertices).in_view(second);
    const auto buffer = DepthBuffer<kSharedDepth>::select(second, left, right);
    const Span rows = pixel_span(t.ay, t.by, t.cy, height);
    draw(make_planes(t, second ? width2 : width, rows.first),
         Span{max(rows.first, buffer.box.y0), min(rows.last, buffer.box.y1 - 1)}, buffer);
  }

  /// What threads draw, the tall ones first: two threads share the rows of one.
  __device__ __forceinline__ void few(const VisibleList& list) const {
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    const int warps = static_cast<int>(blockDim.x) / kWarp;
    const int flat = list.counts->flat, tall = 2 * list.counts->tall;
    const int tall_warps = (tall + kWarp - 1) / kWarp;
    const int end = tall_warps + (flat + kWarp - 1) / kWarp;
    for (int i = static_cast<int>(threadIdx.x) / kWarp; i < end; i += warps) {
      const bool is_tall = i < tall_warps;
      const int wanted = (is_tall ? i : i - tall_warps) * kWarp + lane;
      const int place = min(wanted, (is_tall ? tall : flat) - 1);  // of the last one: no rows
      const int entry = is_tall ? list.tall[place / 2] : list.entries[place];
      prepared(entry, [&](const auto& p, Span rows, const auto& buffer) {
        const int middle = (rows.first + rows.last) / 2;
        if (is_tall && place % 2 == 0) rows.last = middle;
        if (is_tall && place % 2 != 0) rows.first = middle + 1;
        if (place < wanted) rows.last = rows.first - 1;
        fill_few(p, rows, buffer);
      });
    }
  }

  /// What a warp each draws.
  __device__ __forceinline__ void many(const VisibleList& list) const {
    const int warps = static_cast<int>(blockDim.x) / kWarp;
    const int count = list.counts->large;
    for (int i = static_cast<int>(threadIdx.x) / kWarp; i < count; i += warps) {
      prepared(list.entries[list.capacity - 1 - i],
               [](const auto& p, Span rows, const auto& buffer) { fill_many(p, rows, buffer); });
      __syncwarp();
    }
  }
};

}  // namespace hypotrack::cuda
