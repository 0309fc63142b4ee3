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

/// A line's part where a + slope * dx >= 0, cut off `columns` (floats, inclusive).
__device__ __forceinline__ void cut(float a, float slope, float inverse_slope, float& first,
                                    float& last) {
  const float zero = -a * inverse_slope;
  if (slope > 0.0f) {
    first = fmaxf(first, zero);
  } else {
    last = fminf(last, zero);
  }
}

/// Draws a triangle of few pixels with one thread: what of every row lies within all three edges.
template <bool kShared>
__device__ __forceinline__ void fill_few(const Planes& p, Span rows,
                                         const DepthBuffer<kShared>& buffer) {
  constexpr float kHorizontal = 1e-20f;  // keeps the slopes of horizontal edges from being zero
  const float a_dx = p.a_dx == 0.0f ? kHorizontal : p.a_dx;
  const float b_dx = p.b_dx == 0.0f ? kHorizontal : p.b_dx;
  float c_dx = -(p.a_dx + p.b_dx);
  if (c_dx == 0.0f) c_dx = kHorizontal;
  const float a_inverse = reciprocal(a_dx), b_inverse = reciprocal(b_dx);
  const float c_inverse = reciprocal(c_dx);
  const float w_dx = fmaf(p.a_dx, p.w_ac, p.b_dx * p.w_bc);
  const float last_column = exact_float(p.x1 - p.x0);
  float dy = exact_float(rows.first - p.y0);
  int row = buffer.index(p.x0, rows.first);
  for (int y = rows.first; y <= rows.last; ++y) {
    const float a = fmaf(dy, p.a_dy, p.a), b = fmaf(dy, p.b_dy, p.b);
    float first = 0.0f, last = last_column;
    cut(a + kInclusive, a_dx, a_inverse, first, last);
    cut(b + kInclusive, b_dx, b_inverse, first, last);
    cut(1.0f - a - b + kInclusive, c_dx, c_inverse, first, last);
    // At most one column beyond either end: a thin triangle's edges may meet far away.
    const int begin = round_up(fminf(first, last_column + 1.0f)),
              end = round_down(fmaxf(last, -1.0f));
    float w = fmaf(exact_float(begin), w_dx, fmaf(a, p.w_ac, fmaf(b, p.w_bc, p.w_c)));
#pragma unroll 1  // one or two pixels in most rows
    for (int i = row + begin; i <= row + end; ++i, w += w_dx) put(buffer.inverse_depth, i, w);
    dy += 1.0f;
    row += buffer.box.width();
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

/// Draws the listed triangles into the z-buffers of one view or of a pair.
template <bool kPair, bool kSharedVertices, bool kSharedDepth>
__device__ __forceinline__ void fill(const PackedTriangle* triangles,
                                     const Vertices<kSharedVertices>& vertices, int width,
                                     int width2, int height, const VisibleList& list,
                                     const DepthBuffer<kSharedDepth>& left,
                                     const DepthBuffer<kSharedDepth>& right) {
  const auto prepared = [&](int entry, const auto& draw) {
    const bool second = kPair && entry % 2 != 0;
    const Corners t = load_corners(triangles[entry / 2], vertices).in_view(second);
    const auto buffer = DepthBuffer<kSharedDepth>::select(second, left, right);
    const Span rows = pixel_span(t.ay, t.by, t.cy, height);
    draw(make_planes(t, second ? width2 : width, rows.first),
         Span{max(rows.first, buffer.box.y0), min(rows.last, buffer.box.y1 - 1)}, buffer);
  };
  const int threads = static_cast<int>(blockDim.x), thread = static_cast<int>(threadIdx.x);
  // Whole warps take turns and wait for their slowest thread: left alone, threads would run ahead
  // into their next triangles one by one, at a fraction of a warp's width.
  const int lane = thread % kWarp;
  for (int base = thread - lane; base < list.counts[0]; base += threads) {
    if (base + lane < list.counts[0]) {
      prepared(list.entries[base + lane],
               [](const auto& p, Span rows, const auto& buffer) { fill_few(p, rows, buffer); });
    }
    __syncwarp();
  }
  for (int i = thread / kWarp; i < list.counts[1]; i += threads / kWarp) {
    prepared(list.entries[list.capacity - 1 - i],
             [](const auto& p, Span rows, const auto& buffer) { fill_many(p, rows, buffer); });
    __syncwarp();
  }
}

}  // namespace hypotrack::cuda
