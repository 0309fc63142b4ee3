#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <mutex>

#include "base/exported.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A pool of memory blocks that are slow to allocate. It keeps returned blocks for reuse and never
/// releases them. Block sizes are rounded up by at most a quarter. Thread-safe.
class BlockPool {
 public:
  /// Allocates memory aligned to 64 bytes; returns null on failure and does not throw.
  using Allocate = std::function<void*(std::size_t bytes)>;

  /// Allocates at most `bound` bytes in total, and nothing more once `allocate` has failed. Blocks
  /// of up to `at_once` bytes together are allocated at once.
  BlockPool(Allocate allocate, std::size_t bound, std::size_t at_once = 0);

  /// Returns a block of at least `bytes` (1 or more) with undefined content, or null if no memory
  /// is left.
  void* take(std::size_t bytes);

  /// Returns a block to the pool; `bytes` must be the number passed to take().
  void give_back(void* block, std::size_t bytes) noexcept;

 private:
  static constexpr std::size_t kClasses = 256;

  void put(void* block, std::size_t index) noexcept;

  Allocate allocate_;
  std::mutex mutex_;
  std::size_t bound_;
  std::size_t at_once_;
  std::size_t reserved_ = 0;
  std::array<void*, kClasses> kept_{};  // linked lists: a block starts with the next address
};

}  // namespace internal
}  // namespace hypotrack::cuda
