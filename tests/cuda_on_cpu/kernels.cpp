#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include "block.hpp"
#include "blocks.hpp"
#include "cuda_on_cpu/threads.hpp"

namespace hypotrack::cuda {
/// The dynamic shared memory of the block that a thread of the CPU works on.
thread_local float4 hypotrack_shared_memory[cuda_on_cpu::kSharedBytes / sizeof(float4)];
}  // namespace hypotrack::cuda

namespace cuda_on_cpu {
namespace {

using Kind = BlockRunner::Kind;

thread_local const ThreadPlace* here = nullptr;  ///< of the thread that runs

BlockRunner& runner() {
  thread_local BlockRunner own(here);
  return own;
}

}  // namespace

void run_block(const ThreadPlace& block, const std::function<void()>& thread) {
  std::memset(hypotrack::cuda::hypotrack_shared_memory, 0xA5, kSharedBytes);
  runner().run(block, thread);
}

const ThreadPlace& this_thread() { return *here; }
int meet_block(bool predicate) { return runner().meet_block(predicate); }
void meet_warp() { runner().meet_warp(); }
void trap() { runner().fail("__trap()"); }

unsigned ballot(unsigned mask, bool predicate) {
  const auto all = runner().exchange(mask, Kind::ballot, predicate ? 1 : 0);
  unsigned bits = 0;
  for (unsigned lane = 0; lane < kWarp; ++lane) {
    if (all.there >> lane & 1 && all.numbers[lane] != 0) bits |= 1u << lane;
  }
  return bits;
}

std::uint64_t shuffle_bits(unsigned mask, std::uint64_t bits, int lane) {
  const auto all = runner().exchange(mask, Kind::shuffle, bits);
  if (lane < 0 || lane >= kWarp || (all.there >> lane & 1) == 0) {
    runner().fail("lane " + std::to_string(lane) + " has no number to take over");
  }
  return all.numbers[lane];
}

void store_in_order(double* to, std::uint64_t bits) {
  release(to);
  __atomic_store_n(reinterpret_cast<std::uint64_t*>(to), bits, __ATOMIC_RELEASE);
}

std::uint64_t load_in_order(const double* from) {
  const std::uint64_t bits =
      __atomic_load_n(reinterpret_cast<const std::uint64_t*>(from), __ATOMIC_ACQUIRE);
  if (kernel_has_failed()) runner().fail("another block has failed");
  // Nothing in it yet (kEmptySlot of bands.cuh): whoever is waited for may need this core.
  if (bits == ~std::uint64_t{0}) {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  } else {
    runner().heard(from);
  }
  return bits;
}

}  // namespace cuda_on_cpu
