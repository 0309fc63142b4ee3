#include "cost/cuda/page_locked_images.hpp"

#include <system_error>
#include <thread>

#include "cost/cuda/device.hpp"
#include "cost/cuda/pooled_mat_allocator.hpp"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

void* page_locked(std::size_t bytes, int device) {
  void* block = nullptr;
  const auto reserve = [&] {
    cudaStreamCaptureMode mode = cudaStreamCaptureModeRelaxed;
    const bool done = cudaSetDevice(device) == cudaSuccess &&
                      cudaThreadExchangeStreamCaptureMode(&mode) == cudaSuccess &&
                      cudaHostAlloc(&block, bytes, cudaHostAllocPortable) == cudaSuccess;
    if (!done) block = nullptr;
  };
  try {
    // Use a separate thread: the threads that make images may use another GPU or capture a graph,
    // which this must not disturb.
    std::thread(reserve).join();
  } catch (const std::system_error&) {
    block = nullptr;
  }
  return block;
}

/// Makes the allocator, which is never destroyed because some images outlive everything else.
PooledMatAllocator* make_allocator(int device, std::size_t most) {
  constexpr std::size_t kAtOnce = 16 << 20;  // to lock pages takes a driver a millisecond
  auto* pool =
      new BlockPool([device](std::size_t n) { return page_locked(n, device); }, most, kAtOnce);
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
