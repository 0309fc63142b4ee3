#pragma once

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/layout.hpp"

/// Skinning, culling and filling by a block of threads: the same geometry and the same rules as the
/// CPU's kernels (core/src/evaluate/{skin,raster}_kernel.cpp), so that the same pixels are covered.
namespace hypotrack::cuda {

// The CPU's simd_kernels.hpp and raster_kernel.cpp explain these.
inline constexpr float kNearest = 0.01f;
inline constexpr float kFarthest = 1000.0f;
inline constexpr float kFarthestPixel = 1 << 20;
inline constexpr float kSmallestArea = 1e-6f;
inline constexpr float kInclusive = 1e-5f;

/// Triangles with more rows or columns are drawn by a whole warp instead of one thread.
inline constexpr int kPixelsPerThread = 8;

/// Projected vertices: x, y (pixels), 1/z (0: not to be drawn) and x in the second view of a pair.
template <bool kShared>
struct Vertices {
  Floats<kShared> records;  ///< four floats per vertex
  __device__ __forceinline__ float4& operator[](int index) const {
    return *reinterpret_cast<float4*>(records.at(4 * index));
  }
};

/// How the second view of a rectified pair sees a projected vertex of the first.
struct Parallax {
  float shift, factor;
  __device__ float operator()(float x, float w) const { return fmaf(factor, w, x + shift); }
};

/// Pixel bounds of a hypothesis, shared by a block.
struct Bounds {
  int low_x, high_x, low_y, high_y, low_x2, high_x2;  ///< high ones: minus the largest
  __device__ void reset() { low_x = high_x = low_x2 = high_x2 = low_y = high_y = 1 << 30; }
  __device__ Box box(int width, int height) const {
    return {max(low_x, 0), max(low_y, 0), min(1 - high_x, width), min(1 - high_y, height)};
  }
  __device__ Box box2(int width, int height) const {
    return {max(low_x2, 0), max(low_y, 0), min(1 - high_x2, width), min(1 - high_y, height)};
  }
};

/// Linear blend skinning of one vertex.
__device__ __forceinline__ float3 skin(const VertexLayout* vertex, const float* bones) {
  const auto* from = reinterpret_cast<const uint2*>(vertex);
  const uint2 xy = from[0], z_bones = from[1], weights = from[2];
  const float x = __uint_as_float(xy.x), y = __uint_as_float(xy.y), z = __uint_as_float(z_bones.x);
  float3 sum = {0.0f, 0.0f, 0.0f};
#pragma unroll
  for (int k = 0; k < 4; ++k) {
    const unsigned units = (k < 2 ? weights.x : weights.y) >> (16 * (k % 2)) & 0xFFFFu;
    if (units == 0) continue;
    const float weight = static_cast<float>(units) * (1.0f / kWholeWeight);
    const auto* m = reinterpret_cast<const float4*>(bones + 12 * (z_bones.y >> (8 * k) & 0xFFu));
    const float4 r0 = m[0], r1 = m[1], r2 = m[2];
    sum.x += weight * (r0.x * x + r0.y * y + r0.z * z + r0.w);
    sum.y += weight * (r1.x * x + r1.y * y + r1.z * z + r1.w);
    sum.z += weight * (r2.x * x + r2.y * y + r2.z * z + r2.w);
  }
  return sum;
}

/// Projects a vertex, given in the frame of the first view's camera, into a view.
__device__ __forceinline__ float3 project(float3 p, const ViewLayout& view, bool first) {
  if (!first) {
    const float* m = view.view_from_first;
    p = {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
         m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
  }
  const float w = reciprocal(p.z);
  const float x = fmaf(p.x * w, view.fx, view.cx), y = fmaf(p.y * w, view.fy, view.cy);
  const bool valid = p.z >= kNearest && p.z <= kFarthest && fabsf(x) <= kFarthestPixel &&
                     fabsf(y) <= kFarthestPixel;
  return {x, y, valid ? w : 0.0f};
}

/// Bounds of a thread's vertices.
struct ThreadBounds {
  static constexpr float kNone = kFarthestPixel;
  float low_x = kNone, high_x = -kNone, low_x2 = kNone, high_x2 = -kNone, low_y = kNone,
        high_y = -kNone;

  __device__ __forceinline__ void add(float x, float x2, float y) {
    low_x = fminf(low_x, x);
    high_x = fmaxf(high_x, x);
    low_x2 = fminf(low_x2, x2);
    high_x2 = fmaxf(high_x2, x2);
    low_y = fminf(low_y, y);
    high_y = fmaxf(high_y, y);
  }
  /// Joins those of the whole block; called by all its threads.
  __device__ __forceinline__ void join(Bounds& all, bool pair) const {
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    int least = warp_min(round_up(low_x));
    const auto next = [&](int place, int value) {
      const int joined = warp_min(value);
      if (lane == place) least = joined;
    };
    next(1, -round_down(high_x));
    next(2, round_up(low_y));
    next(3, -round_down(high_y));
    if (pair) {
      next(4, round_up(low_x2));
      next(5, -round_down(high_x2));
    }
    // One instruction for all of them.
    if (lane < (pair ? 6 : 4)) atomicMin(&all.low_x + lane, least);
  }
};

/// The corners of a triangle in one view.
struct Corners {
  float ax, ay, aw, bx, by, bw, cx, cy, cw;
};

__device__ __forceinline__ float least(float a, float b, float c) { return fminf(fminf(a, b), c); }
__device__ __forceinline__ float most(float a, float b, float c) { return fmaxf(fmaxf(a, b), c); }

/// Pixels whose centres lie within the bounding box, inclusive, cut to 0 .. size - 1.
struct Span {
  int first, last;
};
__device__ __forceinline__ Span pixel_span(float a, float b, float c, int size) {
  return {round_up(fmaxf(least(a, b, c), 0.0f)),
          round_down(fminf(most(a, b, c), exact_float(size - 1)))};
}

/// Twice the signed area, pixels^2; negative if counter-clockwise from outside (y is downwards).
__device__ __forceinline__ float twice_area(const Corners& t) {
  return (t.bx - t.ax) * (t.cy - t.ay) - (t.cx - t.ax) * (t.by - t.ay);
}

/// The records of a triangle's corners.
struct CornerRecords {
  float4 a, b, c;
  __device__ __forceinline__ Corners in_view(bool second) const {
    return {second ? a.w : a.x, a.y, a.z, second ? b.w : b.x, b.y, b.z,
            second ? c.w : c.x, c.y, c.z};
  }
};

template <bool kShared>
__device__ __forceinline__ CornerRecords load_corners(PackedTriangle triangle,
                                                      const Vertices<kShared>& vertices) {
  const auto corner = [&](int k) {
    return vertices[static_cast<int>(static_cast<std::uint32_t>(triangle >> (k * kVertexBits)) &
                                     kVertexMask)];
  };
  return {corner(0), corner(1), corner(2)};
}

/// Visible triangles of a chunk: 2 * (number within the chunk) + view. Those for one thread each
/// grow from the front, those for a warp each from the back.
struct VisibleList {
  std::uint16_t* entries;
  int capacity;
  int* counts;  ///< of the front and of the back
};
inline constexpr int kLongestChunk = 1 << 15;

enum class Coverage { none, few, many };

/// Appends an entry per view where there is coverage; called by whole warps.
__device__ __forceinline__ void append(const VisibleList& list, Coverage left, Coverage right,
                                       int entry) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const unsigned below = (1u << lane) - 1u;
  const auto append_those = [&](Coverage wanted, int& count, int first, int step) {
    const unsigned in_left = __ballot_sync(kWholeWarp, left == wanted);
    const unsigned in_right = __ballot_sync(kWholeWarp, right == wanted);
    int base = 0;
    if (lane == 0) base = atomicAdd(&count, __popc(in_left) + __popc(in_right));
    base = __shfl_sync(kWholeWarp, base, 0);
    const auto put = [&](int place, int what) {
      list.entries[first + step * place] = static_cast<std::uint16_t>(what);
    };
    if (left == wanted) put(base + __popc(in_left & below), entry);
    if (right == wanted) put(base + __popc(in_left) + __popc(in_right & below), entry + 1);
  };
  append_those(Coverage::few, list.counts[0], 0, 1);
  if (__any_sync(kWholeWarp, left == Coverage::many || right == Coverage::many)) {
    append_those(Coverage::many, list.counts[1], list.capacity - 1, -1);
  }
}

/// How many pixels of `rows` a triangle may cover in a view `width` pixels wide.
__device__ __forceinline__ Coverage coverage(const Corners& t, bool two_sided, int width,
                                             Span rows) {
  const float area = -twice_area(t);
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  if (!((two_sided ? fabsf(area) : area) > kSmallestArea)) return Coverage::none;
  if (columns.first > columns.last) return Coverage::none;
  const int extent = max(columns.last - columns.first, rows.last - rows.first);
  return extent >= kPixelsPerThread ? Coverage::many : Coverage::few;
}

/// Lists which of `count` triangles may cover pixels of the rows y0 <= y < y1 in
/// a view or, with kPair, in either view of a pair.
template <bool kPair, bool kShared>
__device__ __forceinline__ void cull(const PackedTriangle* triangles,
                                     const Vertices<kShared>& vertices, int width, int width2,
                                     int y0, int y1, int count, const VisibleList& list) {
  const int rounded = (count + kWarp - 1) / kWarp * kWarp;
  const float low = exact_float(y0), high = exact_float(y1 - 1);
  for (int i = static_cast<int>(threadIdx.x); i < rounded; i += static_cast<int>(blockDim.x)) {
    const PackedTriangle triangle = i < count ? triangles[i] : 0;
    const CornerRecords records = load_corners(triangle, vertices);
    const Corners t = records.in_view(false);
    const Span rows = {round_up(fmaxf(least(t.ay, t.by, t.cy), low)),
                       round_down(fminf(most(t.ay, t.by, t.cy), high))};
    const bool in_rows = i < count && rows.first <= rows.last && least(t.aw, t.bw, t.cw) > 0.0f;
    if (!__any_sync(kWholeWarp, in_rows)) continue;
    Coverage left = Coverage::none, right = Coverage::none;
    if (in_rows) {
      const bool two_sided = (triangle >> (3 * kVertexBits)) != 0;
      left = coverage(t, two_sided, width, rows);
      if (kPair) right = coverage(records.in_view(true), two_sided, width2, rows);
    }
    append(list, left, right, 2 * i);
  }
}

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
