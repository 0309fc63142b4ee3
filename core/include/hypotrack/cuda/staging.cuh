#pragma once

#include <cuda_pipeline_primitives.h>

#include <cstdint>

#include "hypotrack/cuda/runtime.cuh"

/// Copies of whole objects from device memory to a block's shared memory.
namespace hypotrack::cuda {

/// Where a block's copies report, in shared memory.
using StagingBarrier = std::uint64_t;

/// The copies of one block, begun one after the other and then waited for together. Both memories
/// are aligned to 16 bytes and go on to a multiple of 16. From compute capability 9.0 on one
/// thread leaves them to the copy engine of its multiprocessor (PTX ISA, cp.async.bulk), and
/// before, all threads copy. All threads call everything, once per kernel.
class Staging {
 public:
  __device__ __forceinline__ explicit Staging(StagingBarrier& barrier) {
#if __CUDA_ARCH__ >= 900
    barrier_ = shared_address(&barrier);
    if (threadIdx.x > 0) return;
    asm volatile("mbarrier.init.shared::cta.b64 [%0], 1;" ::"r"(barrier_) : "memory");
    asm volatile("fence.mbarrier_init.release.cluster;" ::: "memory");
#endif
  }

  template <class T>
  __device__ __forceinline__ void add(const T* from, int count, void* to) {
    const unsigned bytes =
        (static_cast<unsigned>(sizeof(T)) * static_cast<unsigned>(count) + 15) / 16 * 16;
#if __CUDA_ARCH__ >= 900
    if (threadIdx.x > 0 || bytes == 0) return;
    bytes_ += bytes;
    asm volatile(
        "cp.async.bulk.shared::cluster.global.mbarrier::complete_tx::bytes [%0], [%1], %2, [%3];" ::
            "r"(shared_address(to)),
        "l"(from), "r"(bytes), "r"(barrier_)
        : "memory");
#else
    const auto* pieces = reinterpret_cast<const uint4*>(from);
    auto* out = reinterpret_cast<uint4*>(to);
    for (unsigned i = threadIdx.x; i < bytes / sizeof(uint4); i += blockDim.x) {
      __pipeline_memcpy_async(out + i, pieces + i, sizeof(uint4));
    }
#endif
  }

  /// Waits for all of them, and until all threads have come here.
  __device__ __forceinline__ void finish() {
#if __CUDA_ARCH__ >= 900
    if (threadIdx.x == 0) {
      asm volatile("mbarrier.arrive.expect_tx.shared::cta.b64 _, [%0], %1;" ::"r"(barrier_),
                   "r"(bytes_)
                   : "memory");
    }
    __syncthreads();  // before, the barrier may not be there
    unsigned is_done = 0;
    while (is_done == 0) {
      asm volatile(
          "{\n"
          ".reg .pred done;\n"
          "mbarrier.try_wait.parity.shared::cta.b64 done, [%1], 0;\n"
          "selp.u32 %0, 1, 0, done;\n"
          "}"
          : "=r"(is_done)
          : "r"(barrier_)
          : "memory");
    }
#else
    __pipeline_commit();
    __pipeline_wait_prior(0);
    __syncthreads();
#endif
  }

 private:
#if __CUDA_ARCH__ >= 900
  __device__ __forceinline__ static unsigned shared_address(const void* object) {
    return static_cast<unsigned>(__cvta_generic_to_shared(object));
  }

  unsigned barrier_ = 0;
  unsigned bytes_ = 0;  ///< that were added
#endif
};

}  // namespace hypotrack::cuda
