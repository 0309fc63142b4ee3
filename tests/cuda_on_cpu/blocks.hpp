#pragma once

#include <cstddef>
#include <functional>

#include "cuda_on_cpu/threads.hpp"

namespace cuda_on_cpu {

// Of the device that the CPU stands in for.
inline constexpr std::size_t kSharedBytes = std::size_t{227} << 10;
inline constexpr int kMostThreadsOfBlock = 1024;
/// As many as an H100 has, so that work is shared out as there; the thread sanitizer takes fibers
/// for threads and knows 8,128 of them at most.
int multiprocessors();

/// On the calling thread of the CPU, of which only one block at a time is worked on. In its dynamic
/// shared memory there is nothing that anybody may rely on.
void run_block(const ThreadPlace& block, const std::function<void()>& thread);

/// Runs all blocks: all at once, of which there are at most as many as multiprocessors, or a few at
/// a time in their order, at least two. Throws KernelError.
void run_blocks(dim3 grid, dim3 block, bool at_once, const std::function<void()>& thread);
/// Whether a block of the kernel that runs has failed.
bool kernel_has_failed();

}  // namespace cuda_on_cpu
