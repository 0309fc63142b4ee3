#pragma once

#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"
#include "cost/cuda/memory/block_pool.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// An OpenCV allocator that takes images from a BlockPool. OpenCV's own allocator handles small
/// images, images in the caller's memory, and all others if the pool is empty. It must outlive its
/// images.
class PooledMatAllocator final : public cv::MatAllocator {
 public:
  static constexpr std::size_t kSmallest = 64 << 10;  // bytes

  /// The pool must outlive the allocator.
  explicit PooledMatAllocator(BlockPool& pool) : pool_(pool) {}

  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag access, cv::UMatUsageFlags usage) const override;
  bool allocate(cv::UMatData* image, cv::AccessFlag access,
                cv::UMatUsageFlags usage) const override;
  void deallocate(cv::UMatData* image) const override;

 private:
  cv::UMatData* from_pool(std::size_t bytes) const;

  BlockPool& pool_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
