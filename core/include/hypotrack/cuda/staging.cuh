#pragma once

#include <cuda_pipeline_primitives.h>

#include <cstdint>

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/runtime.cuh"

/// Copies of whole objects from device memory to a block's shared memory.
namespace hypotrack::cuda {

/// Where a block's copies report, in shared memory.
using StagingBarrier = std::uint64_t;

/// The copies of one block, begun one after the other and then waited for together. Both memories
/// are aligned to 16 bytes and go on to a multiple of 16. From compute capability 9.0 on one
/// thread leaves them to the copy engine of its multiprocessor (PTX ISA, cp.async.bulk), and
/// before, all threads copy. All threads call everything.
class Staging {
 public:
  __device__ __forceinline__ explicit Staging(StagingBarrier& barrier)
      : threads_(static_cast<int>(blockDim.x)) {
#if __CUDA_ARCH__ >= 900
    barrier_ = shared_address(&barrier);
    if (!leads()) return;
    asm volatile("mbarrier.init.shared::cta.b64 [%0], 1;" ::"r"(barrier_) : "memory");
    asm volatile("fence.mbarrier_init.release.cluster;" ::: "memory");
#endif
  }

  template <class T>
  __device__ __forceinline__ void add(const T* from, int count, void* to) {
    const unsigned bytes =
        (static_cast<unsigned>(sizeof(T)) * static_cast<unsigned>(count) + 15) / 16 * 16;
#if __CUDA_ARCH__ >= 900
    if (!leads() || bytes == 0) return;
    bytes_ += bytes;
    asm volatile(
        "cp.async.bulk.shared::cluster.global.mbarrier::complete_tx::bytes [%0], [%1], %2, [%3];" ::
            "r"(shared_address(to)),
        "l"(from), "r"(bytes), "r"(barrier_)
        : "memory");
#else
    const auto* pieces = reinterpret_cast<const uint4*>(from);
    auto* out = reinterpret_cast<uint4*>(to);
    const auto threads = static_cast<unsigned>(threads_);
    for (unsigned i = threadIdx.x; i < bytes / sizeof(uint4); i += threads) {
      __pipeline_memcpy_async(out + i, pieces + i, sizeof(uint4));
    }
#endif
  }

  /// Waits for all of them, and until all threads have come here.
  __device__ __forceinline__ void finish() {
    expect();
    __syncthreads();  // before, the barrier may not be there
    wait(0);
  }

  /// Of a block that copies anew, with its first `threads` threads, more than a warp: all of them
  /// call add() and then expect(), after a barrier behind whatever touched what is overwritten.
  /// Another barrier must follow, and wait().
  __device__ __forceinline__ Staging(StagingBarrier& barrier, int threads)
      : leader_(kWarp), threads_(threads) {  // the first warp may have other things to do
#if __CUDA_ARCH__ >= 900
    barrier_ = shared_address(&barrier);
    // What threads did to the memory comes before what the copy engine does.
    if (leads()) asm volatile("fence.proxy.async.shared::cta;" ::: "memory");
#endif
  }
  __device__ __forceinline__ void expect() const {
#if __CUDA_ARCH__ >= 900
    if (!leads()) return;
    asm volatile("mbarrier.arrive.expect_tx.shared::cta.b64 _, [%0], %1;" ::"r"(barrier_),
                 "r"(bytes_)
                 : "memory");
#else
    __pipeline_commit();
    __pipeline_wait_prior(0);
#endif
  }
  /// Waits for the copies of the barrier's use number `use`, of which the first is 0.
  __device__ __forceinline__ static void wait(StagingBarrier& barrier, unsigned use) {
#if __CUDA_ARCH__ >= 900
    await(shared_address(&barrier), use % 2);
#endif
  }

 private:
  __device__ __forceinline__ bool leads() const { return static_cast<int>(threadIdx.x) == leader_; }
  __device__ __forceinline__ void wait(unsigned use) const {
#if __CUDA_ARCH__ >= 900
    await(barrier_, use);
#endif
  }
#if __CUDA_ARCH__ >= 900
  __device__ __forceinline__ static void await(unsigned barrier, unsigned parity) {
    unsigned is_done = 0;
    while (is_done == 0) {
      asm volatile(
          "{\n"
          ".reg .pred done;\n"
          "mbarrier.try_wait.parity.shared::cta.b64 done, [%1], %2;\n"
          "selp.u32 %0, 1, 0, done;\n"
          "}"
          : "=r"(is_done)
          : "r"(barrier), "r"(parity)
          : "memory");
    }
  }

  unsigned barrier_ = 0;
  unsigned bytes_ = 0;  ///< that were added
#endif
  int leader_ = 0;  ///< the thread that leaves copies to the copy engine
  int threads_;     ///< that copy, where there is none
};

}  // namespace hypotrack::cuda
