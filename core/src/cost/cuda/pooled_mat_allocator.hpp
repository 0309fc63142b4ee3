#pragma once

#include <opencv2/core/mat.hpp>

#include "cost/cuda/block_pool.hpp"

namespace hypotrack::cuda {

/// Makes images in the blocks of a pool. What is small, what the pool has no block for and what
/// lies in the caller's memory is left to OpenCV's own allocator. Outlives the images it makes.
class PooledMatAllocator final : public cv::MatAllocator {
 public:
  static constexpr std::size_t kSmallest = 64 << 10;  // bytes of an image from the pool

  /// The pool outlives it.
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

}  // namespace hypotrack::cuda
