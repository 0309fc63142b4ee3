#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "cost/cuda/memory/block_pool.hpp"

namespace hypotrack::test {

/// A pool of ordinary memory, freed with it, that counts what it gets.
class PoolOnHost {
 public:
  explicit PoolOnHost(std::size_t bound, std::size_t at_once = 0)
      : pool([this](std::size_t bytes) { return allocate(bytes); }, bound, at_once) {}

  int allocations() const { return static_cast<int>(blocks_.size()); }
  std::size_t last_bytes() const { return blocks_.back().bytes; }
  std::size_t total_bytes() const {
    std::size_t sum = 0;
    for (const Block& block : blocks_) sum += block.bytes;
    return sum;
  }
  /// Whether a pointer is into one of the blocks.
  bool owns(const void* at) const {
    const auto* byte = static_cast<const std::byte*>(at);
    for (const Block& block : blocks_) {
      const std::byte* first = block.memory.get();
      if (byte >= first && byte < first + block.bytes) return true;
    }
    return false;
  }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(std::byte* memory) const { ::operator delete(memory, kAlignment); }
  };
  struct Block {
    std::unique_ptr<std::byte, Free> memory;
    std::size_t bytes;
  };

  void* allocate(std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    auto* memory = static_cast<std::byte*>(::operator new(bytes, kAlignment));
    blocks_.push_back({std::unique_ptr<std::byte, Free>(memory), bytes});
    return memory;
  }

  std::mutex mutex_;
  std::vector<Block> blocks_;

 public:
  cuda::BlockPool pool;
};

}  // namespace hypotrack::test
