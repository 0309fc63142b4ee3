#pragma once

#include <cuda_pipeline_primitives.h>

#include <cstdint>

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/runtime.cuh"

/// Asynchronous copies of whole objects from device memory to a block's shared memory.
namespace hypotrack::cuda {

/// The barrier in shared memory that a block's copies complete on (mbarrier).
using StagingBarrier = std::uint64_t;

/// A set of copies by one block, which waits for all of them together. Both addresses are aligned
/// to 16 bytes, and both memories extend to a multiple of 16. From compute capability 9.0 on, one
/// thread uses the multiprocessor's copy engine (PTX ISA, cp.async.bulk). On older devices, all
/// threads copy. All threads must call every function.
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

  /// Waits for all copies, and for all threads of the block.
  __device__ __forceinline__ void finish() {
    expect();
    __syncthreads();  // the mbarrier may not be initialised before
    wait(0);
  }

  /// Starts another set of copies with the first `threads` threads (more than a warp). A barrier
  /// must separate it from earlier access to the overwritten memory. Those threads call add() and
  /// then expect(); another barrier and wait() must follow.
  __device__ __forceinline__ Staging(StagingBarrier& barrier, int threads)
      : leader_(kWarp), threads_(threads) {  // the first warp may be busy
#if __CUDA_ARCH__ >= 900
    barrier_ = shared_address(&barrier);
    // Orders earlier accesses by threads before the copy engine's writes.
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
  /// Waits for the copies of the barrier's use number `use`, counted from 0.
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
  unsigned bytes_ = 0;  ///< total of add()
#endif
  int leader_ = 0;  ///< index of the thread that starts the copies
  int threads_;     ///< number of copying threads on older devices
};

}  // namespace hypotrack::cuda
