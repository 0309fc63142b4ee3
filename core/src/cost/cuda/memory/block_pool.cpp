#include "cost/cuda/memory/block_pool.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace hypotrack::cuda::internal {
namespace {

/// A size class; there are four between two powers of two.
struct SizeClass {
  std::size_t index;
  std::size_t capacity;
};

SizeClass size_class(std::size_t bytes) {
  constexpr std::size_t kSmallest = 64;
  const std::size_t last = std::max(bytes, kSmallest) - 1;
  const auto bits = static_cast<std::size_t>(std::bit_width(last));
  const std::size_t quarters = last >> (bits - 3);  // 4 to 7
  return {4 * bits + quarters - 8, (quarters + 1) << (bits - 3)};
}

}  // namespace

BlockPool::BlockPool(Allocate allocate, std::size_t bound, std::size_t at_once)
    : allocate_(std::move(allocate)), bound_(bound), at_once_(at_once) {}

void* BlockPool::take(std::size_t bytes) {
  std::unique_lock lock(mutex_);
  if (bytes > bound_) return nullptr;
  const SizeClass size = size_class(bytes);
  if (void* block = kept_[size.index]) {
    std::memcpy(&kept_[size.index], block, sizeof(void*));
    return block;
  }
  if (size.capacity > bound_ || reserved_ > bound_ - size.capacity) return nullptr;
  const std::size_t blocks =
      std::clamp<std::size_t>(at_once_ / size.capacity, 1, (bound_ - reserved_) / size.capacity);
  reserved_ += blocks * size.capacity;
  lock.unlock();  // other threads need not wait for the slow allocation
  void* first = allocate_(blocks * size.capacity);
  lock.lock();
  if (!first) {
    reserved_ -= blocks * size.capacity;
    bound_ = std::min(bound_, reserved_);
    return nullptr;
  }
  for (std::size_t i = 1; i < blocks; ++i)
    put(static_cast<std::byte*>(first) + i * size.capacity, size.index);
  return first;
}

void BlockPool::put(void* block, std::size_t index) noexcept {
  std::memcpy(block, &kept_[index], sizeof(void*));
  kept_[index] = block;
}

void BlockPool::give_back(void* block, std::size_t bytes) noexcept {
  const SizeClass size = size_class(bytes);
  const std::scoped_lock lock(mutex_);
  put(block, size.index);
}

}  // namespace hypotrack::cuda::internal
