#include "cost/cuda/page_locked_images.hpp"

#include <system_error>
#include <thread>

#include "cost/cuda/device.hpp"
#include "cost/cuda/pooled_mat_allocator.hpp"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr std::size_t kBound = std::size_t{1} << 30;

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
PooledMatAllocator* make_allocator(int device) {
  auto* pool = new BlockPool([device](std::size_t n) { return page_locked(n, device); }, kBound);
  return new PooledMatAllocator(*pool);
}

}  // namespace

void page_lock_images(int device) {
  if (!why_no_device(device).empty() || !why_not_this_device(device).empty()) return;
  static const cv::MatAllocator* const installed = [device] {
    cv::MatAllocator* allocator = make_allocator(device);
    cv::Mat::setDefaultAllocator(allocator);
    return allocator;
  }();
  (void)installed;
}

}  // namespace hypotrack::cuda::internal
