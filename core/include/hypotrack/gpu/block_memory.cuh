#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {

/// Device memory of the blocks of a BlockPlan.
class BlockMemory {
 public:
  /// Allocates what a plan for `count` hypotheses needs and enters it in the plan. `bands` blocks
  /// per hypothesis, or those of the plan if there are more, each with `sums` numbers.
  void reserve(BlockPlan& plan, std::int64_t count, int bands, int sums) {
    const auto hypotheses = static_cast<std::size_t>(count);
    const auto blocks = hypotheses * static_cast<std::size_t>(plan.bands);
    if (!plan.vertices_in_shared) {
      vertices_.reserve(blocks * 4 * static_cast<std::size_t>(plan.vertex_stride));
    }
    if (plan.depth_scratch_size > 0) {
      depth_.reserve(blocks * static_cast<std::size_t>(plan.depth_scratch_size));
    }
    const auto most_bands = static_cast<std::size_t>(std::max(plan.bands, bands));
    if (most_bands > 1 && sums_.reserve(hypotheses * most_bands * static_cast<std::size_t>(sums))) {
      static_assert(kEmptySlot == ~std::uint64_t{0});
      check(cudaMemset(sums_.data(), 0xFF, sums_.size() * sizeof(double)), "emptying memory");
      check(cudaDeviceSynchronize(), "emptying memory");
    }
    plan.vertex_scratch = vertices_.data();
    plan.depth_scratch = depth_.data();
    plan.band_sums = sums_.data();
  }

 private:
  DeviceBuffer<float> vertices_, depth_;
  DeviceBuffer<double> sums_;
};

}  // namespace hypotrack::cuda
