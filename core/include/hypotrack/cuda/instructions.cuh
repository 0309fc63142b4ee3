#pragma once

#include <cstdint>

/// Instructions that CUDA C++ has no name for (PTX ISA), but for those of the copy engine
/// (staging.cuh, which does without for older devices). The rest of all kernels is C++, so that
/// they can also be compiled for a CPU: tests/cuda_on_cpu has a header in place of this one.
namespace hypotrack::cuda {

/// 1 / x within a unit of the last digit, for x whose reciprocal is a normal number.
__device__ __forceinline__ float reciprocal(float x) {
  float r;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(x));
  return r;
}

/// The root within 3e-7 relative; of subnormal numbers 0.
__device__ __forceinline__ float approximate_sqrt(float x) {
  float root;
  asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(root) : "f"(x));
  return root;
}

/// 2^x within 2^-22 relative; subnormal results are 0.
__device__ __forceinline__ float approximate_exp2(float x) {
  float power;
  asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(power) : "f"(x));
  return power;
}

/// Where something lies in shared memory, bytes.
using SharedAddress = unsigned;
__device__ __forceinline__ SharedAddress shared_address(const void* object) {
  return static_cast<SharedAddress>(__cvta_generic_to_shared(object));
}

/// The int at an address becomes the larger one of itself and `value`, atomically, if `wanted`:
/// without a branch.
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

/// Access to device memory past a multiprocessor's own cache, in no order with other accesses.
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
