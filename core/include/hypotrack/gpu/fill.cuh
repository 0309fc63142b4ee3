#pragma once

#include <cstdint>
#include <type_traits>

#include "hypotrack/gpu/cull.cuh"

/// Draws triangles into z-buffers with a block of threads. The operations equal those of the CPU
/// kernel (core/src/cost/draw/raster_kernel.cpp), so that both cover the same pixels with the same
/// depth.
namespace hypotrack::cuda {

/// Widening of the edges, as a share of a triangle's height, so that no pixel falls between two
/// triangles.
inline constexpr float kInclusive = 1e-5f;

/// Slope (barycentric coordinate per pixel) below which an edge counts as horizontal.
inline constexpr float kHorizontal = 1e-20f;

/// Intersection of an edge with the pixel rows: x = at + dy * per_row, in pixels from Planes::x0.
/// `right` tells on which side the triangle lies.
struct Crossing {
  float at, per_row;
  bool right;

  /// Clips the columns first .. last to the inner side of the edge.
  __device__ __forceinline__ void cut(float dy, float& first, float& last) const {
    const float x = fmaf(dy, per_row, at);
    if (right) {
      first = fmaxf(first, x);
    } else {
      last = fminf(last, x);
    }
  }
};

/// Returns the crossing of the edge a + dx * a_dx + dy * a_dy = 0, slightly widened.
__device__ __forceinline__ Crossing crossing(float a, float a_dx, float a_dy) {
  const float slope = fabsf(a_dx) < kHorizontal ? kHorizontal : a_dx;
  const float inverse = -exact_reciprocal(slope);
  return {(a + kInclusive) * inverse, a_dy * inverse, slope > 0.0f};
}

/// Edge crossings of a triangle and 1/z as a plane, relative to pixel (x0, y0). Edges a, b and c
/// are opposite to their corners.
struct Planes {
  int x0, x1, y0;
  Crossing a, b, c;
  float w, w_dx, w_dy;

  /// Returns the covered columns of row y0 + dy, relative to x0.
  __device__ __forceinline__ Span columns(float dy) const {
    return columns_of_row(a, b, c, dy, exact_float(x1 - x0));
  }
  __device__ __forceinline__ static Span columns_of_row(const Crossing& a, const Crossing& b,
                                                        const Crossing& c, float dy,
                                                        float last_column) {
    float first = 0.0f, last = last_column;
    a.cut(dy, first, last);
    b.cut(dy, first, last);
    c.cut(dy, first, last);
    // Allow at most one column beyond either end: the edges of a thin triangle may meet far away.
    return {round_up(fminf(first, last_column + 1.0f)), round_down(fmaxf(last, -1.0f))};
  }
};

/// Computes the planes of a triangle in a view `width` pixels wide.
__device__ __forceinline__ Planes make_planes(const Corners& t, int width, int first_row) {
  Planes p;
  const Span columns = pixel_span(t.ax, t.bx, t.cx, width);
  p.x0 = columns.first;
  p.x1 = columns.last;
  p.y0 = first_row;
  // Coordinates relative to the first pixel are small, so their products are accurate.
  const float x = exact_float(p.x0), y = exact_float(p.y0);
  const Corners s = {t.ax - x, t.ay - y, t.aw, t.bx - x, t.by - y, t.bw, t.cx - x, t.cy - y, t.cw};
  const float area = twice_area(s), inverse_area = exact_reciprocal(area);
  // Barycentric coordinates of corners a and b as planes.
  const float a = fmaf(s.bx, s.cy, -(s.cx * s.by)) * inverse_area;
  const float a_dx = (s.by - s.cy) * inverse_area;
  const float a_dy = (s.cx - s.bx) * inverse_area;
  const float b = fmaf(s.cx, s.ay, -(s.ax * s.cy)) * inverse_area;
  const float b_dx = (s.cy - s.ay) * inverse_area;
  const float b_dy = (s.ax - s.cx) * inverse_area;
  p.a = crossing(a, a_dx, a_dy);
  if (area == 0.0f) p.a = {kFarthestPixel, 0.0f, true};  // covers nothing
  p.b = crossing(b, b_dx, b_dy);
  p.c = crossing(1.0f - a - b, -(a_dx + b_dx), -(a_dy + b_dy));
  const float w_ac = t.aw - t.cw, w_bc = t.bw - t.cw;
  p.w = fmaf(a, w_ac, fmaf(b, w_bc, t.cw));
  p.w_dx = fmaf(a_dx, w_ac, b_dx * w_bc);
  p.w_dy = fmaf(a_dy, w_ac, b_dy * w_bc);
  return p;
}

/// Writes a pixel with an atomic maximum: the larger 1/z wins in any order of writes.
template <bool kShared>
__device__ __forceinline__ void put(const Floats<kShared>& depth, int index, float w) {
  // Positive floats compare like integers.
  atomicMax(reinterpret_cast<int*>(depth.at(index)), __float_as_int(w));
}

/// Writes consecutive pixels of a row.
template <bool kShared>
class PixelWriter {
 public:
  __device__ __forceinline__ PixelWriter(const Floats<kShared>& depth, int index)
      : next_(address(depth.at(index))) {}

  /// Writes the next pixel if `is_there`, else skips it.
  __device__ __forceinline__ void put(float w, bool is_there) {
    if constexpr (kShared) {
      // No branch, and no new look-up of the shared-memory address per pixel.
      shared_max(next_, __float_as_int(w), is_there);
    } else if (is_there) {
      atomicMax(reinterpret_cast<int*>(next_), __float_as_int(w));
    }
    next_ += sizeof(float);
  }

 private:
  using Address = std::conditional_t<kShared, SharedAddress, std::uintptr_t>;
  __device__ __forceinline__ static Address address(float* pixel) {
    if constexpr (kShared) return shared_address(pixel);
    return reinterpret_cast<std::uintptr_t>(pixel);
  }

  Address next_;
};

/// The rows of one small triangle per thread. The threads of the warp share the rows of all their
/// triangles.
class FewRows {
 public:
  /// `rows` are the rows to draw; `pixel` is the z-buffer index of column p.x0 in the first of
  /// them.
  __device__ __forceinline__ FewRows(const Planes& p, Span rows, int pixel, bool second)
      : a_(p.a),
        b_(p.b),
        c_(p.c),
        w_(p.w),
        w_dx_(p.w_dx),
        w_dy_(p.w_dy),
        pixel_(pixel),
        count_(rows.last - rows.first + 1),
        shape_(pack(a_.right, 0) | pack(b_.right, 1) | pack(c_.right, 2) | pack(second, kSecond) |
               pack(p.x1 - p.x0, kLast) | pack(rows.first - p.y0, kSkipped)) {}

  /// Draws the rows of all the warp's triangles, one row per thread at a time. `is_there`: this
  /// thread has a triangle. `pitches` are those of the two views.
  template <bool kShared>
  __device__ __forceinline__ void draw(bool is_there, int2 pitches, const Floats<kShared>& depth) {
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    const int end = warp_scan(is_there ? count_ : 0);
    const int begin = is_there ? end - count_ : end;
    shape_ |= pack(begin, kBegin);
    const int total = __shfl_sync(kWholeWarp, end, kWarp - 1);
#pragma unroll 1
    for (int first = 0; first < total; first += kWarp) {
      // Every triangle has at least one row. So the number of triangles that have begun gives the
      // owner of a row.
      const int at = begin - first;
      const unsigned begins = warp_or(at >= 0 && at < kWarp ? 1u << at : 0u);
      const int earlier = __popc(__ballot_sync(kWholeWarp, at < 0));
      const int owner = earlier + __popc(begins & ((2u << lane) - 1u)) - 1;
      const bool is_row = first + lane < total;
      FewRows of_owner = *this;
      of_owner.fetch(owner);
      of_owner.draw_row(first + lane, is_row, pitches, depth);
    }
  }

 private:
  // shape_ packs, from bit 0: one bit per edge whose inner side is to the right, the second-view
  // bit and the last column. Then follow the index of the triangle's first row among the warp's
  // rows, and the number of its rows above the first drawn one.
  static constexpr int kSecond = 3, kLast = 4, kBegin = 7, kSkipped = 16;
  static_assert(kPixelsPerThread <= 8 && kWarp * kPixelsPerThread < 1 << (kSkipped - kBegin));

  __device__ __forceinline__ static unsigned pack(int value, int bit) {
    return static_cast<unsigned>(value) << bit;
  }
  __device__ __forceinline__ int unpack(int bit, int bits) const {
    return static_cast<int>(shape_ >> bit & ((1u << bits) - 1u));
  }

  /// Copies the triangle of another thread of the warp.
  __device__ __forceinline__ void fetch(int lane) {
    const auto get = [&](auto& value) { value = __shfl_sync(kWholeWarp, value, lane); };
    get(shape_);
    for (Crossing* crossing : {&a_, &b_, &c_}) {
      get(crossing->at);
      get(crossing->per_row);
    }
    a_.right = unpack(0, 1) != 0;
    b_.right = unpack(1, 1) != 0;
    c_.right = unpack(2, 1) != 0;
    get(w_);
    get(w_dx_);
    get(w_dy_);
    get(pixel_);
  }

  /// Draws row `number` of the warp's rows. All threads run the same number of iterations.
  /// Otherwise they would leave the loop one by one and waste most of the warp's width.
  template <bool kShared>
  __device__ __forceinline__ void draw_row(int number, bool is_row, int2 pitches,
                                           const Floats<kShared>& depth) const {
    const int row = number - unpack(kBegin, kSkipped - kBegin);
    const float dy = exact_float(row + unpack(kSkipped, 32 - kSkipped));
    const float last_column = exact_float(unpack(kLast, kBegin - kLast));
    const Span columns = Planes::columns_of_row(a_, b_, c_, dy, last_column);
    const int count = is_row ? columns.last - columns.first + 1 : 0, most = warp_max(count);
    const float row_w = fmaf(dy, w_dy_, w_);
    const int pitch = unpack(kSecond, 1) != 0 ? pitches.y : pitches.x;
    PixelWriter<kShared> pixels(depth, pixel_ + row * pitch + columns.first);
    float dx = exact_float(columns.first);
#pragma unroll 1  // most rows have one or two pixels
    for (int k = 0; k < most; ++k, dx += 1.0f) pixels.put(fmaf(dx, w_dx_, row_w), k < count);
  }

  Crossing a_, b_, c_;
  float w_, w_dx_, w_dy_;  ///< 1/z at (Planes::x0, y0) and its slopes
  int pixel_, count_;
  unsigned shape_;
};

/// Draws a large triangle with a warp.
template <bool kShared>
__device__ __forceinline__ void fill_many(const Planes& p, Span rows,
                                          const DepthBuffer<kShared>& buffer) {
  constexpr int kWide = 8, kHigh = kWarp / kWide;  // pixels that the warp draws together
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int y = rows.first + lane / kWide; y <= rows.last; y += kHigh) {
    const float dy = exact_float(y - p.y0), row_w = fmaf(dy, p.w_dy, p.w);
    const Span columns = p.columns(dy);
    for (int dx = columns.first + lane % kWide; dx <= columns.last; dx += kWide) {
      put(buffer.inverse_depth, buffer.index(p.x0 + dx, y), fmaf(exact_float(dx), p.w_dx, row_w));
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

  /// Calls draw(planes, rows, z-buffer) for an entry of a VisibleList.
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

  /// Draws the small triangles, one row per thread.
  __device__ __forceinline__ void few(const VisibleList& list) const {
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    const int warp = static_cast<int>(threadIdx.x) / kWarp;
    const int warps = static_cast<int>(blockDim.x) / kWarp;
    const int count = list.counts->few;
    // If there are too few for all lanes, distribute them evenly over the warps.
    const int at_once = min(small_quotient(count + warps - 1, warps), kWarp);
    for (int base = warp * at_once; base < count; base += warps * at_once) {
      const bool is_there = lane < at_once && base + lane < count;
      const int place = min(base + lane, count - 1);
      const int entry = list.entries[place];
      prepared(entry, [&](const Planes& p, Span rows, const auto& buffer) {
        const int pixel = buffer.inverse_depth.offset + buffer.index(p.x0, rows.first);
        FewRows few_rows(p, rows, pixel, kPair && entry % 2 != 0);
        few_rows.draw(is_there, {left.box.width(), right.box.width()},
                      Floats<kSharedDepth>{left.inverse_depth.global, 0});
      });
    }
  }

  /// Draws the large triangles, one per warp.
  __device__ __forceinline__ void many(const VisibleList& list) const {
    const int warps = static_cast<int>(blockDim.x) / kWarp;
    const int count = list.counts->many;
    for (int i = static_cast<int>(threadIdx.x) / kWarp; i < count; i += warps) {
      prepared(list.entries[list.capacity - 1 - i],
               [](const auto& p, Span rows, const auto& buffer) { fill_many(p, rows, buffer); });
      __syncwarp();
    }
  }
};

}  // namespace hypotrack::cuda
