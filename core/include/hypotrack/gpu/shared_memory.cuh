#pragma once

#include <cstddef>

#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {

/// Returns the most shared memory, in bytes, that a block of a launch may ask for.
inline std::size_t most_shared_bytes(const DeviceLimits& limits) {
  return static_cast<std::size_t>(limits.shared_bytes_per_block - detail::kReservedBytes);
}

/// Lets launches of a kernel ask for most_shared_bytes(). The permission is the kernel's in the
/// whole process: with what one scene needs, it would be too little for another tracker's.
template <class Kernel>
void allow_shared_memory(Kernel* kernel, const DeviceLimits& limits) {
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                             static_cast<int>(most_shared_bytes(limits))),
        "reserving shared memory");
}

}  // namespace hypotrack::cuda
