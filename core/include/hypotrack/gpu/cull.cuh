#pragma once

#include "hypotrack/gpu/vertices.cuh"

/// Finds the triangles that may cover pixels, with a block of threads. The operations equal those
/// of the CPU kernel (core/src/cost/draw/raster_kernel.cpp), so that both cover the same pixels
/// with the same depth.
namespace hypotrack::cuda {

/// Smallest area of a triangle that is drawn (twice the area, pixels^2). Below it, single precision
/// gives only noise.
inline constexpr float kSmallestArea = 1e-6f;
/// Most rows or columns of a small triangle, which threads draw one row each. A whole warp draws a
/// larger triangle.
inline constexpr int kPixelsPerThread = 8;

/// The corners of a triangle in one view: pixels x, y and inverse depth w.
struct Corners {
  float ax, ay, aw, bx, by, bw, cx, cy, cw;
};

__device__ __forceinline__ float least(float a, float b, float c) { return fminf(fminf(a, b), c); }
__device__ __forceinline__ float most(float a, float b, float c) { return fmaxf(fmaxf(a, b), c); }

/// Pixels whose centres lie within the bounding box, inclusive, clamped to 0 .. size - 1.
struct Span {
  int first, last;
};
/// Returns the pixels between the smallest and the largest of three coordinates.
__device__ __forceinline__ Span pixel_span(float a, float b, float c, int size) {
  return {round_up(fmaxf(least(a, b, c), 0.0f)),
          round_down(fminf(most(a, b, c), exact_float(size - 1)))};
}

/// Returns twice the signed area, pixels^2; negative if counter-clockwise from outside (y is down).
__device__ __forceinline__ float twice_area(const Corners& t) {
  return fmaf(t.bx - t.ax, t.cy - t.ay, -((t.cx - t.ax) * (t.by - t.ay)));
}

/// The vertex records of a triangle's corners.
struct CornerRecords {
  float4 a, b, c;
  __device__ __forceinline__ Corners in_view(bool second) const {
    return {second ? a.w : a.x, a.y, a.z, second ? b.w : b.x, b.y, b.z,
            second ? c.w : c.x, c.y, c.z};
  }
};

/// The vertex indices of a triangle.
struct TriangleCorners {
  int a, b, c;
  __device__ __forceinline__ explicit TriangleCorners(PackedTriangle packed)
      : a(vertex(packed, 0)), b(vertex(packed, 1)), c(vertex(packed, 2)) {}

 private:
  __device__ __forceinline__ static int vertex(PackedTriangle packed, int corner) {
    return static_cast<int>(static_cast<std::uint32_t>(packed >> (corner * kVertexBits)) &
                            kVertexMask);
  }
};

template <bool kShared>
__device__ __forceinline__ CornerRecords load_corners(const TriangleCorners& corners,
                                                      const Vertices<kShared>& vertices) {
  return {vertices[corners.a], vertices[corners.b], vertices[corners.c]};
}

/// Visible triangles of a chunk in one view or a pair; an entry is 2 * (index in the chunk) + view.
/// Small triangles grow from the front, large ones from the back.
struct VisibleList {
  std::uint16_t* entries;
  int capacity;
  struct Counts {
    int few, many;
    __device__ void reset() { few = many = 0; }
  } * counts;
};

enum class Coverage { none, few, many };

/// Appends `entry` for the left view and `entry` + 1 for the right one, where wanted; called by
/// whole warps.
__device__ __forceinline__ void append(std::uint16_t* first, int step, int& count, bool left,
                                       bool right, int entry) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const unsigned below = (1u << lane) - 1u;
  const unsigned in_left = __ballot_sync(kWholeWarp, left);
  const unsigned in_right = __ballot_sync(kWholeWarp, right);
  const int lefts = __popc(in_left);
  int base = 0;
  if (lane == 0) base = atomicAdd(&count, lefts + __popc(in_right));
  base = __shfl_sync(kWholeWarp, base, 0);
  const auto put = [&](int place, int what) {
    first[step * place] = static_cast<std::uint16_t>(what);
  };
  if (left) put(base + __popc(in_left & below), entry);
  if (right) put(base + lefts + __popc(in_right & below), entry + 1);
}

/// Appends a warp's triangles to the lists of small and large ones.
__device__ __forceinline__ void append(const VisibleList& list, Coverage left, Coverage right,
                                       int entry) {
  const auto append_those = [&](Coverage wanted, std::uint16_t* first, int step, int& count) {
    append(first, step, count, left == wanted, right == wanted, entry);
  };
  append_those(Coverage::few, list.entries, 1, list.counts->few);
  if (!__any_sync(kWholeWarp, left == Coverage::many || right == Coverage::many)) return;
  append_those(Coverage::many, list.entries + list.capacity - 1, -1, list.counts->many);
}

/// Classifies how many pixels of `rows` a triangle may cover in a view `width` pixels wide.
__device__ __forceinline__ Coverage coverage(const Corners& t, bool two_sided, int width,
                                             Span rows) {
  const float area = -twice_area(t);
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  if (!((two_sided ? fabsf(area) : area) > kSmallestArea)) return Coverage::none;
  if (columns.first > columns.last) return Coverage::none;
  const int longest = max(columns.last - columns.first, rows.last - rows.first);
  return longest < kPixelsPerThread ? Coverage::few : Coverage::many;
}

/// Lists the triangles that may cover rows y0 <= y < y1 of a view or, with kPair, of either view of
/// a pair. `count` is the number of triangles. The first warp takes the last triangles and so never
/// more than another warp, because one of its threads may arrive late.
template <bool kPair, bool kShared>
__device__ __forceinline__ void cull(const Staged<PackedTriangle>& triangles,
                                     const Vertices<kShared>& vertices, int width, int width2,
                                     int y0, int y1, int count, const VisibleList& list) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const int warps = static_cast<int>(blockDim.x) / kWarp;
  const float low = exact_float(y0), high = exact_float(y1 - 1);
  const Heights<kShared> heights(vertices);
#pragma unroll 1  // keeps the code short
  for (int base = (warp > 0 ? warp - 1 : warps - 1) * kWarp; base < count; base += warps * kWarp) {
    const bool there = base + lane < count;
    const PackedTriangle triangle = there ? triangles[base + lane] : 0;
    const TriangleCorners corners(triangle);
    // Most triangles lie in other rows; their heights alone show that.
    const float ay = heights(corners.a), by = heights(corners.b), cy = heights(corners.c);
    const float top = least(ay, by, cy), bottom = most(ay, by, cy);
    if (!__any_sync(kWholeWarp, there && bottom >= low && top <= high)) continue;
    const Span rows = {round_up(fmaxf(top, low)), round_down(fminf(bottom, high))};
    Coverage left = Coverage::none, right = Coverage::none;
    if (there && rows.first <= rows.last) {
      const CornerRecords records = load_corners(corners, vertices);
      const Corners t = records.in_view(false);
      if (least(t.aw, t.bw, t.cw) > 0.0f) {
        const bool two_sided = (triangle >> (3 * kVertexBits)) != 0;
        left = coverage(t, two_sided, width, rows);
        if (kPair) {
          right = coverage(records.in_view(true), two_sided, width2, rows);
        }
      }
    }
    append(list, left, right, 2 * (base + lane));
  }
}

}  // namespace hypotrack::cuda
