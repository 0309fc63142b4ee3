#include "cost/cuda/memory/pooled_mat_allocator.hpp"

#include <limits>
#include <memory>

namespace hypotrack::cuda::internal {
namespace {

/// Returns the bytes of an image without gaps; 0 if it is empty or too large.
std::size_t bytes_of(int dims, const int* sizes, int type) {
  std::size_t bytes = static_cast<std::size_t>(CV_ELEM_SIZE(type));
  for (int i = 0; i < dims; ++i) {
    if (sizes[i] <= 0) return 0;
    const auto size = static_cast<std::size_t>(sizes[i]);
    if (bytes > std::numeric_limits<std::size_t>::max() / size) return 0;
    bytes *= size;
  }
  return bytes;
}

/// Computes the bytes between elements of each dimension, without gaps.
void set_steps(int dims, const int* sizes, int type, std::size_t* step) {
  std::size_t bytes = static_cast<std::size_t>(CV_ELEM_SIZE(type));
  for (int i = dims - 1; i >= 0; --i) {
    step[i] = bytes;
    bytes *= static_cast<std::size_t>(sizes[i]);
  }
}

}  // namespace

cv::UMatData* PooledMatAllocator::from_pool(std::size_t bytes) const {
  auto image = std::make_unique<cv::UMatData>(this);
  void* block = pool_.take(bytes);
  if (!block) return nullptr;
  image->data = image->origdata = static_cast<unsigned char*>(block);
  image->size = bytes;
  return image.release();
}

cv::UMatData* PooledMatAllocator::allocate(int dims, const int* sizes, int type, void* data,
                                           std::size_t* step, cv::AccessFlag access,
                                           cv::UMatUsageFlags usage) const {
  const std::size_t bytes = bytes_of(dims, sizes, type);
  cv::UMatData* image = !data && bytes >= kSmallest ? from_pool(bytes) : nullptr;
  if (!image) {
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, access, usage);
  }
  if (step) set_steps(dims, sizes, type, step);
  return image;
}

bool PooledMatAllocator::allocate(cv::UMatData* image, cv::AccessFlag, cv::UMatUsageFlags) const {
  return image != nullptr;
}

void PooledMatAllocator::deallocate(cv::UMatData* image) const {
  if (!image) return;
  CV_Assert(image->refcount == 0 && image->urefcount == 0);
  pool_.give_back(image->origdata, image->size);
  delete image;
}

}  // namespace hypotrack::cuda::internal
