#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <mutex>

namespace hypotrack::cuda {

/// Blocks of memory that is slow to get: what is given back is kept and handed out again, never
/// released. Block sizes are rounded up by a quarter at most. Threads may share one.
class BlockPool {
 public:
  /// Gets memory, aligned to 64 bytes; null if there is none. Does not throw.
  using Allocate = std::function<void*(std::size_t bytes)>;

  /// Gets at most `bound` bytes altogether, and no more once `allocate` has failed.
  BlockPool(Allocate allocate, std::size_t bound);

  /// At least `bytes` (1 or more) of undefined content; null where none is kept and no more may be
  /// had.
  void* take(std::size_t bytes);

  /// Gives a block back that was taken with `bytes`.
  void give_back(void* block, std::size_t bytes) noexcept;

 private:
  static constexpr std::size_t kClasses = 256;

  Allocate allocate_;
  std::mutex mutex_;
  std::size_t bound_;
  std::size_t reserved_ = 0;
  std::array<void*, kClasses> kept_{};  // lists: a kept block begins with where the next one is
};

}  // namespace hypotrack::cuda
