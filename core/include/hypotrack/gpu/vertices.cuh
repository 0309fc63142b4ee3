#pragma once

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/layout.hpp"

/// Skins and projects vertices with a block of threads. The operations equal those of the CPU
/// kernel (core/src/scene/skin_kernel.cpp), so that both cover the same pixels with the same
/// depth.
namespace hypotrack::cuda {

// Explained in core/src/scene/simd_kernels.hpp.
inline constexpr float kNearest = 0.01f;
inline constexpr float kFarthest = 1000.0f;
inline constexpr float kFarthestPixel = 1 << 20;

/// Projected vertices: x, y (pixels), 1/z (0 = do not draw) and x in the second view of a pair.
template <bool kShared>
struct Vertices {
  Floats<kShared> records;  ///< four floats per vertex
  int heights;  ///< offset of a second copy of every y, relative to the records; -1 = none
  __device__ __forceinline__ float4& operator[](int index) const {
    return *reinterpret_cast<float4*>(records.at(4 * index));
  }
  __device__ __forceinline__ void put(int index, const float4& record) const {
    (*this)[index] = record;
    if (heights >= 0) records[heights + index] = record.y;
  }
};

/// Reads the vertices' y from where access is fastest.
template <bool kShared>
class Heights {
 public:
  __device__ __forceinline__ explicit Heights(const Vertices<kShared>& vertices)
      : first_(vertices.records.at(vertices.heights < 0 ? 1 : vertices.heights)),
        step_(vertices.heights < 0 ? 4 : 1) {}
  __device__ __forceinline__ float operator()(int index) const { return first_[step_ * index]; }

 private:
  const float* first_;
  int step_;
};

/// Maps a projected vertex of a rectified pair's first view to its x in the second.
struct Parallax {
  float shift, factor;
  __device__ float operator()(float x, float w) const { return fmaf(factor, w, x + shift); }
};

/// Pixel bounds of a hypothesis, shared by a block.
struct Bounds {
  int low_x, high_x, low_y, high_y, low_x2, high_x2;  ///< high ones: minus the largest value
  __device__ void reset() { low_x = high_x = low_x2 = high_x2 = low_y = high_y = 1 << 30; }
  __device__ Box box(int width, int height) const {
    return {max(low_x, 0), max(low_y, 0), min(1 - high_x, width), min(1 - high_y, height)};
  }
  __device__ Box box2(int width, int height) const {
    return {max(low_x2, 0), max(low_y, 0), min(1 - high_x2, width), min(1 - high_y, height)};
  }
};

/// The words of a VertexLayout, as loaded from memory.
struct VertexWords {
  uint2 words[sizeof(VertexLayout) / sizeof(uint2)];
};

/// Returns a row of a 3x4 matrix times (x y z 1).
__device__ __forceinline__ float affine(const float4& row, float x, float y, float z) {
  return fmaf(row.x, x, fmaf(row.y, y, fmaf(row.z, z, row.w)));
}

/// Computes linear blend skinning of one vertex.
__device__ __forceinline__ float3 skin(const VertexWords& vertex, const float* bones) {
  const uint2 xy = vertex.words[0], z_bones = vertex.words[1], weights = vertex.words[2];
  const float x = __uint_as_float(xy.x), y = __uint_as_float(xy.y), z = __uint_as_float(z_bones.x);
  float3 sum = {0.0f, 0.0f, 0.0f};
#pragma unroll
  for (int k = 0; k < 4; ++k) {
    const unsigned pair = k < 2 ? weights.x : weights.y;
    if ((pair >> (16 * (k % 2)) & 0xFFFFu) == 0) continue;
    const float weight = k % 2 == 0 ? exact_low_half(pair) : exact_high_half(pair);
    const auto* m = reinterpret_cast<const float4*>(bones + 12 * (z_bones.y >> (8 * k) & 0xFFu));
    const float4 r0 = m[0], r1 = m[1], r2 = m[2];
    sum.x = fmaf(weight, affine(r0, x, y, z), sum.x);
    sum.y = fmaf(weight, affine(r1, x, y, z), sum.y);
    sum.z = fmaf(weight, affine(r2, x, y, z), sum.z);
  }
  constexpr float kUnit = 1.0f / kUnitWeight;
  return {sum.x * kUnit, sum.y * kUnit, sum.z * kUnit};
}

/// Projects a vertex, in the frame of the first view's camera, into a view. For a pair, `view` is
/// the first one.
template <bool kPair>
__device__ __forceinline__ float3 project(float3 p, const ViewLayout& view, bool first) {
  if (!kPair && !first) {
    const float* m = view.view_from_first;
    const auto row = [&](int i) {
      return affine({m[i], m[i + 1], m[i + 2], m[i + 3]}, p.x, p.y, p.z);
    };
    p = {row(0), row(4), row(8)};
  }
  const float w = exact_reciprocal(p.z);
  const float x = fmaf(p.x * w, view.fx, view.cx), y = fmaf(p.y * w, view.fy, view.cy);
  const bool valid = p.z >= kNearest && p.z <= kFarthest && fabsf(x) <= kFarthestPixel &&
                     fabsf(y) <= kFarthestPixel;
  return {x, y, valid ? w : 0.0f};
}

/// Bounds of one thread's vertices.
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
  /// Joins the bounds of all threads of the block; all must call it.
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
    // One atomic instruction for all bounds.
    if (lane < (pair ? 6 : 4)) atomicMin(&all.low_x + lane, least);
  }
};

}  // namespace hypotrack::cuda
