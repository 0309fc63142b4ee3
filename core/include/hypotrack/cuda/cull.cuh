#pragma once

#include "hypotrack/cuda/vertices.cuh"

/// Which triangles may cover pixels, found by a block of threads.
/// The same geometry and the same rules as the CPU's kernels
/// (core/src/evaluate/{skin,raster}_kernel.cpp), so that the same pixels are covered.
namespace hypotrack::cuda {

/// Triangles with less area (twice, pixels^2) are noise of single precision.
inline constexpr float kSmallestArea = 1e-6f;
/// Triangles with more rows or columns are drawn by a whole warp instead of one thread.
inline constexpr int kPixelsPerThread = 8;

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

}  // namespace hypotrack::cuda
