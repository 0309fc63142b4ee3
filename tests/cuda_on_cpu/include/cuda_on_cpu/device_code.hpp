#pragma once

#include <math.h>  // CUDA has its functions in the global namespace

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "cuda_on_cpu/threads.hpp"
#include "cuda_on_cpu/vector_types.hpp"

/// What CUDA C++ adds to C++, as far as hypotrack's kernels use it. Code is compiled as for compute
/// capability 7.5 (__CUDA_ARCH__), the oldest there is, so that it uses no more than what follows.
#define __global__
#define __device__
#define __host__
#define __forceinline__ inline __attribute__((always_inline))
#define __grid_constant__
#define __launch_bounds__(threads)
/// A block is worked on by one thread of the CPU at a time, which has this memory for itself.
#define __shared__ thread_local

namespace cuda_on_cpu {
/// A number of the thread that runs.
template <uint3 ThreadPlace::*kVector, unsigned uint3::*kAxis>
struct Number {
  operator unsigned() const { return this_thread().*kVector.*kAxis; }
};
template <uint3 ThreadPlace::*kVector>
struct Vector {
  Number<kVector, &uint3::x> x;
  Number<kVector, &uint3::y> y;
  Number<kVector, &uint3::z> z;
};
}  // namespace cuda_on_cpu
inline constexpr cuda_on_cpu::Vector<&cuda_on_cpu::ThreadPlace::thread> threadIdx;
inline constexpr cuda_on_cpu::Vector<&cuda_on_cpu::ThreadPlace::block> blockIdx;
inline constexpr cuda_on_cpu::Vector<&cuda_on_cpu::ThreadPlace::block_size> blockDim;
inline constexpr cuda_on_cpu::Vector<&cuda_on_cpu::ThreadPlace::grid_size> gridDim;

inline void __syncthreads() { cuda_on_cpu::meet_block(false); }
inline int __syncthreads_count(int predicate) { return cuda_on_cpu::meet_block(predicate != 0); }
inline void __syncwarp() { cuda_on_cpu::meet_warp(); }
inline void __threadfence_system() {}
inline void __threadfence() {}  // slots are filled and read in order: instructions.cuh
[[noreturn]] inline void __trap() { cuda_on_cpu::trap(); }

inline unsigned __ballot_sync(unsigned mask, int predicate) {
  return cuda_on_cpu::ballot(mask, predicate != 0);
}
inline int __any_sync(unsigned mask, int predicate) { return __ballot_sync(mask, predicate) != 0; }
inline int __all_sync(unsigned mask, int predicate) { return __ballot_sync(mask, !predicate) == 0; }

namespace cuda_on_cpu {
template <class T>
T shuffle(unsigned mask, T value, int lane) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(std::uint64_t));
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  bits = shuffle_bits(mask, bits, lane);
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
}  // namespace cuda_on_cpu
template <class T>
T __shfl_sync(unsigned mask, T value, int lane) {
  return cuda_on_cpu::shuffle(mask, value, lane & 31);
}
template <class T>
T __shfl_xor_sync(unsigned mask, T value, int lanes) {
  return cuda_on_cpu::shuffle(mask, value, cuda_on_cpu::this_thread().lane ^ lanes);
}
template <class T>
T __shfl_up_sync(unsigned mask, T value, unsigned lanes) {
  const int from = cuda_on_cpu::this_thread().lane - static_cast<int>(lanes);
  return cuda_on_cpu::shuffle(mask, value, from < 0 ? cuda_on_cpu::this_thread().lane : from);
}

template <class T>
T atomicAdd(T* at, std::type_identity_t<T> value) {
  return __atomic_fetch_add(at, value, __ATOMIC_RELAXED);
}
namespace cuda_on_cpu {
template <class Integer, class IsBetter>
Integer keep_better(Integer* at, Integer value, const IsBetter& is_better) {
  Integer old = __atomic_load_n(at, __ATOMIC_RELAXED);
  while (is_better(value, old) &&
         !__atomic_compare_exchange_n(at, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return old;
}
}  // namespace cuda_on_cpu
inline int atomicMax(int* at, int value) {
  return cuda_on_cpu::keep_better(at, value, [](int a, int b) { return a > b; });
}
inline int atomicMin(int* at, int value) {
  return cuda_on_cpu::keep_better(at, value, [](int a, int b) { return a < b; });
}
inline unsigned atomicMin(unsigned* at, unsigned value) {
  return cuda_on_cpu::keep_better(at, value, [](unsigned a, unsigned b) { return a < b; });
}

template <class T>
T __ldcg(const T* from) {
  return *from;
}
template <class T>
T __ldg(const T* from) {
  return *from;
}
template <class T>
void __stcg(T* to, std::type_identity_t<T> value) {
  *to = value;
}

inline int __popc(unsigned bits) { return std::popcount(bits); }
inline int __ffs(int bits) { return __builtin_ffs(bits); }
inline int __float_as_int(float x) { return std::bit_cast<int>(x); }
inline unsigned __float_as_uint(float x) { return std::bit_cast<unsigned>(x); }
inline float __int_as_float(int bits) { return std::bit_cast<float>(bits); }
inline float __uint_as_float(unsigned bits) { return std::bit_cast<float>(bits); }
inline double __longlong_as_double(long long bits) { return std::bit_cast<double>(bits); }
inline unsigned __byte_perm(unsigned low, unsigned high, unsigned selector) {
  const std::uint64_t bytes = std::uint64_t{high} << 32 | low;
  unsigned out = 0;
  for (unsigned i = 0; i < 4; ++i) {
    out |= static_cast<unsigned>(bytes >> (8 * (selector >> (4 * i) & 7)) & 0xFF) << (8 * i);
  }
  return out;
}
inline float __fadd_rn(float a, float b) { return a + b; }
inline float __fmaf_rn(float a, float b, float c) { return fmaf(a, b, c); }
inline unsigned __float2uint_rn(float x) { return static_cast<unsigned>(std::nearbyint(x)); }

namespace cuda_on_cpu {
/// What a + b leaves of the exact sum (D. E. Knuth, The Art of Computer Programming 2, 4.2.2).
inline float rest_of_sum(float a, float b) {
  const float sum = a + b, b_part = sum - a;
  return (a - (sum - b_part)) + (b - b_part);
}
}  // namespace cuda_on_cpu
inline float __fadd_ru(float a, float b) {
  return cuda_on_cpu::rest_of_sum(a, b) > 0 ? std::nextafter(a + b, INFINITY) : a + b;
}
inline float __fadd_rd(float a, float b) {
  return cuda_on_cpu::rest_of_sum(a, b) < 0 ? std::nextafter(a + b, -INFINITY) : a + b;
}

inline long long clock64() { return std::chrono::steady_clock::now().time_since_epoch().count(); }
inline float rsqrtf(float x) { return 1 / std::sqrt(x); }
inline double rsqrt(double x) { return 1 / std::sqrt(x); }
template <class A, class B>
constexpr std::common_type_t<A, B> min(A a, B b) {
  return b < a ? b : a;
}
template <class A, class B>
constexpr std::common_type_t<A, B> max(A a, B b) {
  return a < b ? b : a;
}

using cudaTextureObject_t = unsigned long long;
/// There are no textures: OpenGL's pictures are not to be had here (cuda_gl_interop.h).
template <class T>
T tex2DLayered(cudaTextureObject_t, float, float, int) {
  __trap();
}
