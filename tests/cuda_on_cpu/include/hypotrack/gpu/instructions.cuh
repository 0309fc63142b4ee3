#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "cuda_on_cpu/device_code.hpp"

/// What stands in for core/include/hypotrack/gpu/instructions.cuh on the CPU.
namespace hypotrack::cuda {

__device__ __forceinline__ float reciprocal(float x) { return 1.0f / x; }
__device__ __forceinline__ float approximate_sqrt(float x) { return std::sqrt(x); }
__device__ __forceinline__ float approximate_exp2(float x) { return std::exp2(x); }

using SharedAddress = std::uintptr_t;
__device__ __forceinline__ SharedAddress shared_address(const void* object) {
  return reinterpret_cast<SharedAddress>(object);
}
__device__ __forceinline__ void shared_max(SharedAddress address, int value, bool wanted) {
  if (wanted) atomicMax(reinterpret_cast<int*>(address), value);
}

__device__ __forceinline__ void store_relaxed(double* to, double value) {
  cuda_on_cpu::store_in_order(to, std::bit_cast<std::uint64_t>(value));
}
__device__ __forceinline__ void store_relaxed_bits(double* to, std::uint64_t bits) {
  cuda_on_cpu::store_in_order(to, bits);
}
__device__ __forceinline__ std::uint64_t load_relaxed_bits(const double* from) {
  return cuda_on_cpu::load_in_order(from);
}

}  // namespace hypotrack::cuda
