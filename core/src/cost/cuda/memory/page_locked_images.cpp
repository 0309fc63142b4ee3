#include "cost/cuda/memory/page_locked_images.hpp"

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <system_error>
#include <thread>

#include "cost/cuda/device.hpp"
#include "cost/cuda/memory/pooled_mat_allocator.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

/// Returns memory in huge pages, or null. A driver locks them in half of the time that it needs for
/// pages of its own. Threads touch pages side by side, but lock them one after the other.
void* huge_pages(std::size_t bytes) {
  constexpr std::size_t kHuge = 2 << 20, kPage = 4 << 10;
  const std::size_t rounded = (bytes + kHuge - 1) / kHuge * kHuge;
  void* const block = std::aligned_alloc(kHuge, rounded);
  if (!block) return nullptr;
  (void)madvise(block, rounded, MADV_HUGEPAGE);  // if refused, small pages serve
  for (std::size_t i = 0; i < bytes; i += kPage) static_cast<volatile std::byte*>(block)[i] = {};
  return block;
}

/// Returns page-locked memory of a device, or null.
void* locked(std::size_t bytes, int device) {
  cudaStreamCaptureMode mode = cudaStreamCaptureModeRelaxed;
  if (cudaSetDevice(device) != cudaSuccess ||
      cudaThreadExchangeStreamCaptureMode(&mode) != cudaSuccess)
    return nullptr;
  void* const block = huge_pages(bytes);
  if (!block || cudaHostRegister(block, bytes, cudaHostRegisterPortable) != cudaSuccess) {
    std::free(block);
    return nullptr;
  }
  // After a fork, whoever writes a page first gets a copy: the parent's would not be the GPU's.
  (void)madvise(block, bytes, MADV_DONTFORK);
  return block;
}

void* page_locked(std::size_t bytes, int device) {
  void* block = nullptr;
  try {
    // Use a separate thread: the threads that make images may use another GPU or capture a graph,
    // which this must not disturb.
    std::thread([&] { block = locked(bytes, device); }).join();
  } catch (const std::system_error&) {  // no thread
  }
  return block;
}

/// Makes the allocator, which is never destroyed because some images outlive everything else.
PooledMatAllocator* make_allocator(int device, std::size_t most) {
  constexpr std::size_t kShare = 256;  // of the bound, reserved at once for images of one size
  auto* pool = new BlockPool([device](std::size_t n) { return page_locked(n, device); }, most,
                             most / kShare);
  return new PooledMatAllocator(*pool);
}

}  // namespace

void page_lock_images(int device, std::size_t most) {
  if (!why_no_device(device).empty() || !why_not_this_device(device).empty()) return;
  static const cv::MatAllocator* const installed = [device, most] {
    cv::MatAllocator* allocator = make_allocator(device, most);
    cv::Mat::setDefaultAllocator(allocator);
    return allocator;
  }();
  (void)installed;
}

}  // namespace hypotrack::cuda::internal
