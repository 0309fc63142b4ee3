#pragma once

#include <cstdint>

/// Wrappers of PTX instructions without a CUDA C++ name (PTX ISA), except the copy engine's
/// (staging.cuh, with a fallback for older devices). All other kernel code is C++, so that it also
/// compiles for a CPU: tests/cuda_on_cpu replaces this header.
namespace hypotrack::cuda {

/// Returns 1 / x within one unit of the last digit; 1 / x must be a normal number.
__device__ __forceinline__ float reciprocal(float x) {
  float r;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(x));
  return r;
}

/// Returns the square root within 3e-7 relative; 0 for subnormal numbers.
__device__ __forceinline__ float approximate_sqrt(float x) {
  float root;
  asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(root) : "f"(x));
  return root;
}

/// Returns 2^x within 2^-22 relative; subnormal results are 0.
__device__ __forceinline__ float approximate_exp2(float x) {
  float power;
  asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(power) : "f"(x));
  return power;
}

/// An address in shared memory, bytes.
using SharedAddress = unsigned;
__device__ __forceinline__ SharedAddress shared_address(const void* object) {
  return static_cast<SharedAddress>(__cvta_generic_to_shared(object));
}

/// Replaces the int at an address by its maximum with `value`, atomically and without a branch, if
/// `wanted`.
__device__ __forceinline__ void shared_max(SharedAddress address, int value, bool wanted) {
  asm volatile(
      "{\n"
      ".reg .pred there;\n"
      "setp.ne.s32 there, %2, 0;\n"
      "@there red.relaxed.cta.shared::cta.max.s32 [%0], %1;\n"
      "}" ::"r"(address),
      "r"(value), "r"(static_cast<int>(wanted))
      : "memory");
}

/// Access device memory in the L2 cache, unordered with other accesses.
__device__ __forceinline__ void store_relaxed(double* to, double value) {
  asm volatile("st.relaxed.gpu.global.f64 [%0], %1;" ::"l"(to), "d"(value) : "memory");
}
__device__ __forceinline__ void store_relaxed_bits(double* to, std::uint64_t bits) {
  asm volatile("st.relaxed.gpu.global.u64 [%0], %1;" ::"l"(to), "l"(bits) : "memory");
}
__device__ __forceinline__ std::uint64_t load_relaxed_bits(const double* from) {
  std::uint64_t bits;
  asm volatile("ld.relaxed.gpu.global.u64 %0, [%1];" : "=l"(bits) : "l"(from) : "memory");
  return bits;
}

}  // namespace hypotrack::cuda
