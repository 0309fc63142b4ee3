#pragma once

#include <cstdint>

#include "cuda_on_cpu/vector_types.hpp"

/// A kernel's threads on the CPU: fibers of the CPU's thread that works on their block, which take
/// turns where they wait for one another.
namespace cuda_on_cpu {

struct ThreadPlace {
  uint3 thread, block, block_size, grid_size;
  int lane;  ///< within the warp
};
const ThreadPlace& this_thread();

/// Waits for all threads of the block; for how many of them `predicate` is true.
int meet_block(bool predicate);
/// Waits for all threads of the warp.
void meet_warp();
// Of the whole warp: `mask` has all bits set. They order no access to memory.
unsigned ballot(unsigned mask, bool predicate);
std::uint64_t shuffle_bits(unsigned mask, std::uint64_t bits, int lane);
/// Ends the kernel with an error.
[[noreturn]] void trap();

// Slots through which one block hands numbers to another.
void store_in_order(double* to, std::uint64_t bits);
std::uint64_t load_in_order(const double* from);

}  // namespace cuda_on_cpu
