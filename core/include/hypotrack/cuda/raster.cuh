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

/// Triangles whose boxes have more pixels are drawn by a whole warp instead of one thread.
inline constexpr int kPixelsPerThread = 48;

/// Projected vertices: pixels and 1/z; w = 0: not to be drawn.
template <bool kShared>
struct Vertices {
  Floats<kShared> x, y, w;
};

/// How the second view of a rectified pair sees a projected vertex of the first.
struct Parallax {
  float shift, factor;
  __device__ float operator()(float x, float w) const { return fmaf(factor, w, x + shift); }
};

/// Pixel bounds of a hypothesis, shared by a block.
struct Bounds {
  int low_x, high_x, low_x2, high_x2, low_y, high_y;  ///< high ones: minus the largest
  __device__ void reset() { low_x = high_x = low_x2 = high_x2 = low_y = high_y = 1 << 30; }
  __device__ Box box(int width, int height) const {
    return {max(low_x, 0), max(low_y, 0), min(1 - high_x, width), min(1 - high_y, height)};
  }
  __device__ Box box2(int width, int height) const {
    return {max(low_x2, 0), max(low_y, 0), min(1 - high_x2, width), min(1 - high_y, height)};
  }
};

/// A vertex and its bones as they lie in memory, so that they can be fetched ahead of their use.
struct LoadedVertex {
  VertexLayout vertex;
  VertexBones bones;
};

__device__ __forceinline__ LoadedVertex load_vertex(const SceneLayout& scene, int index) {
  LoadedVertex v;
  const auto* from = reinterpret_cast<const float4*>(scene.vertices + index);
  const float4 a = __ldg(from), b = __ldg(from + 1);
  const ushort4 c = __ldg(reinterpret_cast<const ushort4*>(scene.vertex_bones) + index);
  v.vertex = {{a.x, a.y, a.z}, 0.0f, {b.x, b.y, b.z, b.w}};
  v.bones = {{c.x, c.y, c.z, c.w}};
  return v;
}

__device__ __forceinline__ float3 skin(const LoadedVertex& v, const float* bones) {
  const float* p = v.vertex.position;
  float3 sum = {0.0f, 0.0f, 0.0f};
#pragma unroll
  for (int k = 0; k < 4; ++k) {
    const float weight = v.vertex.weights[k];
    if (weight == 0.0f) continue;
    const auto* m = reinterpret_cast<const float4*>(bones + 12 * v.bones.bone[k]);
    const float4 r0 = m[0], r1 = m[1], r2 = m[2];
    sum.x += weight * (r0.x * p[0] + r0.y * p[1] + r0.z * p[2] + r0.w);
    sum.y += weight * (r1.x * p[0] + r1.y * p[1] + r1.z * p[2] + r1.w);
    sum.z += weight * (r2.x * p[0] + r2.y * p[1] + r2.z * p[2] + r2.w);
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
  const float w = 1.0f / p.z;
  const float x = fmaf(p.x * w, view.fx, view.cx), y = fmaf(p.y * w, view.fy, view.cy);
  const bool valid = p.z >= kNearest && p.z <= kFarthest && fabsf(x) <= kFarthestPixel &&
                     fabsf(y) <= kFarthestPixel;
  return {x, y, valid ? w : 0.0f};
}

/// Bounds of a thread's vertices.
struct ThreadBounds {
  Bounds own;
  __device__ __forceinline__ ThreadBounds() { own.reset(); }
  __device__ __forceinline__ void add(float x, float x2, float y) {
    own.low_x = min(own.low_x, __float2int_ru(x));
    own.high_x = min(own.high_x, -__float2int_rd(x));
    own.low_x2 = min(own.low_x2, __float2int_ru(x2));
    own.high_x2 = min(own.high_x2, -__float2int_rd(x2));
    own.low_y = min(own.low_y, __float2int_ru(y));
    own.high_y = min(own.high_y, -__float2int_rd(y));
  }
  /// Joins those of the whole block; called by all its threads.
  __device__ __forceinline__ void join(Bounds& all, bool pair) const {
    join(own.low_x, all.low_x);
    join(own.high_x, all.high_x);
    join(own.low_y, all.low_y);
    join(own.high_y, all.high_y);
    if (!pair) return;
    join(own.low_x2, all.low_x2);
    join(own.high_x2, all.high_x2);
  }

 private:
  __device__ __forceinline__ static void join(int value, int& all) {
    const int least = warp_min(value);
    if (threadIdx.x % kWarp == 0) atomicMin(&all, least);
  }
};

/// The corners of a triangle in one view; of a pair's second view with x already shifted.
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
  return {__float2int_ru(fmaxf(least(a, b, c), 0.0f)),
          __float2int_rd(fminf(most(a, b, c), static_cast<float>(size - 1)))};
}

/// Twice the signed area, pixels^2; negative if counter-clockwise from outside (y is downwards).
__device__ __forceinline__ float twice_area(const Corners& t) {
  return (t.bx - t.ax) * (t.cy - t.ay) - (t.cx - t.ax) * (t.by - t.ay);
}

template <bool kShared>
__device__ __forceinline__ Corners load_corners(PackedTriangle triangle,
                                                const Vertices<kShared>& vertices) {
  const int a = static_cast<int>(static_cast<std::uint32_t>(triangle) & kVertexMask);
  const int b = static_cast<int>(static_cast<std::uint32_t>(triangle >> kVertexBits) & kVertexMask);
  const int c =
      static_cast<int>(static_cast<std::uint32_t>(triangle >> (2 * kVertexBits)) & kVertexMask);
  return {vertices.x[a], vertices.y[a], vertices.w[a], vertices.x[b], vertices.y[b],
          vertices.w[b], vertices.x[c], vertices.y[c], vertices.w[c]};
}

__device__ __forceinline__ void to_second_view(Corners& t, const Parallax& parallax) {
  t.ax = parallax(t.ax, t.aw);
  t.bx = parallax(t.bx, t.bw);
  t.cx = parallax(t.cx, t.cw);
}

/// Visible triangles of a chunk: 2 * (number within the chunk) + view. Those for one thread each
/// grow from the front, those for a warp each from the back.
struct VisibleList {
  std::uint16_t* entries;
  int capacity;
  int* counts;  ///< of the front and of the back
};
inline constexpr int kLongestChunk = 1 << 15;

/// Appends where `visible`; called by whole warps.
__device__ __forceinline__ void append(const VisibleList& list, bool visible, bool large,
                                       int entry) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const unsigned small_mask = __ballot_sync(kWholeWarp, visible && !large);
  const unsigned large_mask = __ballot_sync(kWholeWarp, visible && large);
  int base = 0;
  if (lane == 0 && small_mask) base = atomicAdd(&list.counts[0], __popc(small_mask));
  base = __shfl_sync(kWholeWarp, base, 0);
  const unsigned below = (1u << lane) - 1u;
  if (visible && !large) {
    list.entries[base + __popc(small_mask & below)] = static_cast<std::uint16_t>(entry);
  }
  if (!large_mask) return;
  if (lane == 0) base = atomicAdd(&list.counts[1], __popc(large_mask));
  base = __shfl_sync(kWholeWarp, base, 0);
  if (visible && large) {
    list.entries[list.capacity - 1 - base - __popc(large_mask & below)] =
        static_cast<std::uint16_t>(entry);
  }
}

/// Whether a triangle covers pixels of `rows` in a view `width` pixels wide, and whether many.
struct Visibility {
  bool visible, large;
};
__device__ __forceinline__ Visibility visibility(const Corners& t, bool two_sided, int width,
                                                 Span rows) {
  const float area = -twice_area(t);
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  const bool seen = (two_sided ? fabsf(area) : area) > kSmallestArea &&
                    columns.first <= columns.last && rows.first <= rows.last;
  const int pixels = (columns.last - columns.first + 1) * (rows.last - rows.first + 1);
  return {seen, pixels > kPixelsPerThread};
}

/// Lists the triangles first .. first + count - 1 that cover pixels of the rows y0 <= y < y1 in a
/// view or, with kPair, in either view of a pair.
template <bool kPair, bool kShared>
__device__ __forceinline__ void cull(const SceneLayout& scene, const Vertices<kShared>& vertices,
                                     const Parallax& parallax, const ViewLayout* views, int y0,
                                     int y1, int first, int count, const VisibleList& list) {
  const int rounded = (count + kWarp - 1) / kWarp * kWarp;
  for (int i = static_cast<int>(threadIdx.x); i < rounded; i += static_cast<int>(blockDim.x)) {
    Visibility left{false, false}, right{false, false};
    if (i < count) {
      const PackedTriangle triangle = __ldg(scene.triangles + first + i);
      Corners t = load_corners(triangle, vertices);
      Span rows = pixel_span(t.ay, t.by, t.cy, views[0].height);
      rows = {max(rows.first, y0), min(rows.last, y1 - 1)};
      if (rows.first <= rows.last && least(t.aw, t.bw, t.cw) > 0.0f) {
        const bool two_sided = (triangle >> (3 * kVertexBits)) != 0;
        left = visibility(t, two_sided, views[0].width, rows);
        if constexpr (kPair) {
          to_second_view(t, parallax);
          right = visibility(t, two_sided, views[1].width, rows);
        }
      }
    }
    append(list, left.visible, left.large, 2 * i);
    if constexpr (kPair) append(list, right.visible, right.large, 2 * i + 1);
  }
}

/// Barycentric coordinates of corners a and b as planes over the pixels from (x0, y0), and 1/z.
struct Planes {
  int x0, x1, y0;
  float a, a_dx, a_dy, b, b_dx, b_dy;
  float w_c, w_ac, w_bc;
};

__device__ __forceinline__ Planes make_planes(const Corners& t, int width, int height) {
  Planes p;
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  p.x0 = columns.first;
  p.x1 = columns.last;
  p.y0 = pixel_span(t.ay, t.by, t.cy, height).first;
  // Coordinates from the first pixel are small, so that their products are exact enough.
  const auto x = static_cast<float>(p.x0), y = static_cast<float>(p.y0);
  const Corners s = {t.ax - x, t.ay - y, t.aw, t.bx - x, t.by - y, t.bw, t.cx - x, t.cy - y, t.cw};
  const float inverse_area = 1.0f / twice_area(s);
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

/// Draws one pixel of a triangle if it covers it: the larger 1/z wins, whoever comes first.
template <bool kShared>
__device__ __forceinline__ void draw_pixel(const Planes& p, int x, int y,
                                           const DepthBuffer<kShared>& buffer) {
  const auto dx = static_cast<float>(x - p.x0), dy = static_cast<float>(y - p.y0);
  const float a = fmaf(dx, p.a_dx, fmaf(dy, p.a_dy, p.a));
  const float b = fmaf(dx, p.b_dx, fmaf(dy, p.b_dy, p.b));
  if (least(a, b, 1.0f - a - b) < -kInclusive) return;
  const float w = fmaf(a, p.w_ac, fmaf(b, p.w_bc, p.w_c));
  // Positive floats order as integers.
  atomicMax(reinterpret_cast<int*>(buffer.inverse_depth.at(buffer.index(x, y))), __float_as_int(w));
}

/// Draws the listed triangles into the z-buffers of one view or of a pair.
template <bool kPair, bool kSharedVertices, bool kSharedDepth>
__device__ __forceinline__ void fill(const SceneLayout& scene,
                                     const Vertices<kSharedVertices>& vertices,
                                     const Parallax& parallax, const ViewLayout* views, int first,
                                     const VisibleList& list,
                                     const DepthBuffer<kSharedDepth>* buffers) {
  const auto planes_of = [&](int entry) {
    Corners t = load_corners(__ldg(scene.triangles + first + entry / 2), vertices);
    const int v = kPair ? entry % 2 : 0;
    if (kPair && v == 1) to_second_view(t, parallax);
    return make_planes(t, views[v].width, views[v].height);
  };
  const auto rows_of = [&](int entry, const DepthBuffer<kSharedDepth>& buffer) {
    const Corners t = load_corners(__ldg(scene.triangles + first + entry / 2), vertices);
    const Span rows = pixel_span(t.ay, t.by, t.cy, views[0].height);
    return Span{max(rows.first, buffer.box.y0), min(rows.last, buffer.box.y1 - 1)};
  };
  for (int i = static_cast<int>(threadIdx.x); i < list.counts[0];
       i += static_cast<int>(blockDim.x)) {
    const int entry = list.entries[i];
    const DepthBuffer<kSharedDepth> buffer = buffers[kPair ? entry % 2 : 0];
    const Planes p = planes_of(entry);
    const Span rows = rows_of(entry, buffer);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = p.x0; x <= p.x1; ++x) draw_pixel(p, x, y, buffer);
    }
  }
  const int warps = static_cast<int>(blockDim.x) / kWarp;
  for (int i = static_cast<int>(threadIdx.x) / kWarp; i < list.counts[1]; i += warps) {
    const int entry = list.entries[list.capacity - 1 - i];
    const DepthBuffer<kSharedDepth> buffer = buffers[kPair ? entry % 2 : 0];
    const Planes p = planes_of(entry);
    const Span rows = rows_of(entry, buffer);
    const int width = p.x1 - p.x0 + 1, pixels = width * (rows.last - rows.first + 1);
    for (int k = static_cast<int>(threadIdx.x) % kWarp; k < pixels; k += kWarp) {
      draw_pixel(p, p.x0 + k % width, rows.first + k / width, buffer);
    }
  }
}

}  // namespace hypotrack::cuda
