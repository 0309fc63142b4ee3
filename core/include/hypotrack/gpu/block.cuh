#pragma once

#include <cstdint>

#include "hypotrack/gpu/instructions.cuh"
#include "hypotrack/gpu/layout.hpp"

/// Primitives for a block of threads: reductions, rounding, shared memory, z-buffers.
namespace hypotrack::cuda {

inline constexpr unsigned kWholeWarp = 0xFFFFFFFFu;
inline constexpr int kWarp = 32;

__device__ __forceinline__ int warp_min(int x) {
#if __CUDA_ARCH__ >= 800
  return __reduce_min_sync(kWholeWarp, x);
#else
  for (int step = kWarp / 2; step > 0; step /= 2) x = min(x, __shfl_xor_sync(kWholeWarp, x, step));
  return x;
#endif
}

__device__ __forceinline__ float warp_sum(float x) {
  for (int step = kWarp / 2; step > 0; step /= 2) x += __shfl_xor_sync(kWholeWarp, x, step);
  return x;
}

__device__ __forceinline__ int warp_max(int x) { return -warp_min(-x); }

__device__ __forceinline__ unsigned warp_or(unsigned x) {
#if __CUDA_ARCH__ >= 800
  return __reduce_or_sync(kWholeWarp, x);
#else
  for (int step = kWarp / 2; step > 0; step /= 2) x |= __shfl_xor_sync(kWholeWarp, x, step);
  return x;
#endif
}

/// Returns the inclusive prefix sum of x over the lanes.
__device__ __forceinline__ int warp_scan(int x) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int step = 1; step < kWarp; step *= 2) {
    const int other = __shfl_up_sync(kWholeWarp, x, step);
    if (lane >= step) x += other;
  }
  return x;
}

// Conversions between float and int for magnitudes below 2^22. The conversion instructions have a
// quarter of an addition's throughput. Adding 1.5 * 2^23 leaves the integer in a float's last bits.
inline constexpr float kIntegerBias = 12582912.0f;
inline constexpr int kIntegerBits = 0x4B400000;
__device__ __forceinline__ int round_up(float x) {
  return __float_as_int(__fadd_ru(x, kIntegerBias)) - kIntegerBits;
}
__device__ __forceinline__ int round_down(float x) {
  return __float_as_int(__fadd_rd(x, kIntegerBias)) - kIntegerBits;
}
/// Rounds to the nearest integer, ties to even.
__device__ __forceinline__ int round_nearest(float x) {
  return __float_as_int(__fadd_rn(x, kIntegerBias)) - kIntegerBits;
}
__device__ __forceinline__ float exact_float(int x) {
  return __int_as_float(x + kIntegerBits) - kIntegerBias;
}

/// Bias that converts a 16-bit half k of a word to a float without a conversion instruction: the
/// last bits of kHalfBias + k are k.
inline constexpr float kHalfBias = 8388608.0f;  // 2^23
__device__ __forceinline__ float biased_low_half(std::uint32_t word) {
  return __uint_as_float(__byte_perm(word, 0x4B000000u, 0x7610));
}
__device__ __forceinline__ float biased_high_half(std::uint32_t word) {
  return __uint_as_float(__byte_perm(word, 0x4B000000u, 0x7632));
}
__device__ __forceinline__ float exact_low_half(std::uint32_t word) {
  return biased_low_half(word) - kHalfBias;
}
__device__ __forceinline__ float exact_high_half(std::uint32_t word) {
  return biased_high_half(word) - kHalfBias;
}

/// Returns 1 / x correctly rounded, as on the CPU; 1 / x must be a normal number. Source: P.
/// Markstein, "Computation of elementary functions on the IBM RISC System/6000 processor", 1990.
__device__ __forceinline__ float exact_reciprocal(float x) {
  const float r = reciprocal(x);
  return fmaf(fmaf(-x, r, 1.0f), r, r);
}

/// Returns a / b, rounded down, for 0 <= a < 2^20 and 0 < b.
__device__ __forceinline__ int small_quotient(int a, int b) {
  // (a + 1/2) / b differs from every integer by at least 1 / (2 b), more than the rounding error.
  return round_down((exact_float(a) + 0.5f) * reciprocal(exact_float(b)));
}

/// A box of pixels: x0 <= x < x1, y0 <= y < y1.
struct Box {
  int x0, y0, x1, y1;
  __device__ int width() const { return x1 - x0; }
  __device__ int height() const { return y1 - y0; }
  __device__ bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// Returns the block's dynamic shared memory.
__device__ __forceinline__ float* shared_floats() {
  extern __shared__ float4 hypotrack_shared_memory[];
  return reinterpret_cast<float*>(hypotrack_shared_memory);
}

/// Copies `count` objects to an offset in shared memory; a barrier must follow.
template <class T>
__device__ __forceinline__ void copy_to_shared(const T* from, int count, int to) {
  const auto* words = reinterpret_cast<const float*>(from);
  const int size = static_cast<int>(sizeof(T) / sizeof(float)) * count;
  for (int i = static_cast<int>(threadIdx.x); i < size; i += static_cast<int>(blockDim.x)) {
    shared_floats()[to + i] = __ldg(words + i);
  }
}

/// An array of floats in global or shared memory. The compiler knows which, so that shared access
/// is cheap.
template <bool kShared>
struct Floats {
  float* global;  ///< base address, unused if kShared
  int offset;     ///< of the first float, from shared_floats() or `global`
  __device__ __forceinline__ float* at(int index) const {
    return (kShared ? shared_floats() : global) + offset + index;
  }
  __device__ __forceinline__ float& operator[](int index) const { return *at(index); }
};

/// Plain objects in global memory or in a shared-memory copy of it.
template <class T>
struct Staged {
  const T* global;
  int offset;  ///< in shared_floats(), if `copied`
  bool copied;
  __device__ __forceinline__ T operator[](int index) const {
    if (copied) return reinterpret_cast<const T*>(shared_floats() + offset)[index];
    return global[index];
  }
};

/// Sets `count` floats to zero with the first `threads` threads of the block; a barrier must
/// follow. `count` and the offset must be multiples of four.
template <bool kShared>
__device__ __forceinline__ void clear(const Floats<kShared>& floats, int count, int threads) {
  const int thread = static_cast<int>(threadIdx.x);
  if (thread >= threads) return;
#pragma unroll 1  // keeps the code short
  for (int i = 4 * thread; i < count; i += 4 * threads) {
    *reinterpret_cast<float4*>(floats.at(i)) = {0.0f, 0.0f, 0.0f, 0.0f};
  }
}
/// Sets `count` floats to zero with all threads of the block; a barrier must follow.
template <bool kShared>
__device__ __forceinline__ void clear(const Floats<kShared>& floats, int count) {
  clear(floats, count, static_cast<int>(blockDim.x));
}

/// A z-buffer of inverse depths over a box of a tile.
template <bool kShared>
struct DepthBuffer {
  Floats<kShared> inverse_depth;
  Box box;
  __device__ __forceinline__ static DepthBuffer select(bool second, const DepthBuffer& a,
                                                       const DepthBuffer& b) {
    return {{second ? b.inverse_depth.global : a.inverse_depth.global,
             second ? b.inverse_depth.offset : a.inverse_depth.offset},
            {second ? b.box.x0 : a.box.x0, a.box.y0, second ? b.box.x1 : a.box.x1, a.box.y1}};
  }
  __device__ __forceinline__ int index(int x, int y) const {
    return (y - box.y0) * box.width() + (x - box.x0);
  }
  __device__ __forceinline__ float operator()(int x, int y) const {
    return y >= box.y0 && y < box.y1 ? in_row(x, y) : 0.0f;
  }
  /// Returns the inverse depth of a pixel inside the box.
  __device__ __forceinline__ float inside(int x, int y) const { return inverse_depth[index(x, y)]; }
  /// Returns the inverse depth of a pixel in one of the box's rows; 0 outside its columns.
  __device__ __forceinline__ float in_row(int x, int y) const {
    return x >= box.x0 && x < box.x1 ? inverse_depth[index(x, y)] : 0.0f;
  }
};

/// Sums the values of all threads in a fixed order, into `total` of the first warp's threads.
/// `room` holds kCount floats per warp of the block.
template <int kCount>
__device__ __forceinline__ void block_sum(const float (&values)[kCount], float* room,
                                          double (&total)[kCount]) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const int warps = static_cast<int>(blockDim.x) / kWarp;
  for (int i = 0; i < kCount; ++i) {
    const float sum = warp_sum(values[i]);
    if (lane == 0) room[warp * kCount + i] = sum;
  }
  __syncthreads();
  if (warp != 0) return;
  for (int i = 0; i < kCount; ++i) {
    total[i] = warp_sum(lane < warps ? room[lane * kCount + i] : 0.0f);
  }
}

}  // namespace hypotrack::cuda
