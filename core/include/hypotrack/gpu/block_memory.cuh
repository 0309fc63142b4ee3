#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

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

/// Device memory of the blocks of a BlockPlan.
class BlockMemory {
 public:
  /// Allocates what a plan for `count` hypotheses needs and enters it in the plan. `bands` blocks
  /// per hypothesis, or those of the plan if there are more, each with `sums` numbers.
  void reserve(BlockPlan& plan, std::int64_t count, int bands, int sums) {
    const auto hypotheses = static_cast<std::size_t>(count);
    const auto blocks = hypotheses * static_cast<std::size_t>(plan.bands);
    if (!plan.vertices_in_shared) {
      grow(vertices_, blocks * 4 * static_cast<std::size_t>(plan.vertex_stride));
    }
    if (plan.depth_scratch_size > 0) {
      grow(depth_, blocks * static_cast<std::size_t>(plan.depth_scratch_size));
    }
    const auto most_bands = static_cast<std::size_t>(std::max(plan.bands, bands));
    if (most_bands > 1 && grow(sums_, hypotheses * most_bands * static_cast<std::size_t>(sums))) {
      static_assert(kEmptySlot == ~std::uint64_t{0});
      check(cudaMemset(sums_.data(), 0xFF, sums_.size() * sizeof(double)), "emptying memory");
      check(cudaStreamSynchronize(nullptr), "emptying memory");
    }
    plan.vertex_scratch = vertices_.data();
    plan.depth_scratch = depth_.data();
    plan.band_sums = sums_.data();
  }

  /// Returns a number that changes whenever memory of earlier plans moves, also in a call that
  /// fails.
  std::uint64_t revision() const { return revision_; }

 private:
  template <class T>
  bool grow(DeviceBuffer<T>& buffer, std::size_t size) {
    if (size > buffer.size()) ++revision_;
    return buffer.reserve(size);
  }

  std::uint64_t revision_ = 0;
  DeviceBuffer<float> vertices_, depth_;
  DeviceBuffer<double> sums_;
};

}  // namespace hypotrack::cuda
