#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"

/// Wrappers of the CUDA runtime for device plugins, also for C++ sources with the toolkit's
/// headers.
namespace hypotrack::cuda {

/// Throws DeviceError if a call failed; `doing` says in the message what was being done.
inline void check(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  (void)cudaGetLastError();  // clears the error of a failed launch
  std::string message = std::string("CUDA: ") + doing + " failed: " + cudaGetErrorString(status) +
                        " (" + cudaGetErrorName(status) + ")";
  if (status == cudaErrorMemoryAllocation) {
    std::size_t free = 0, total = 0;
    if (cudaMemGetInfo(&free, &total) == cudaSuccess) {
      message += "; the device has " + std::to_string(free >> 20) + " of " +
                 std::to_string(total >> 20) + " MiB left";
    }
    message += ". Use fewer particles or smaller tiles";
  }
  if (status == cudaErrorNoKernelImageForDevice || status == cudaErrorInvalidDeviceFunction) {
    message += ". Was it built for another GPU? Set CMAKE_CUDA_ARCHITECTURES";
  }
  throw DeviceError(message);
}

/// Returns the CUDA stream of a Stream.
inline cudaStream_t native(Stream stream) { return static_cast<cudaStream_t>(stream.handle); }

/// Device memory for `size()` objects of T; it never shrinks.
template <class T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  explicit DeviceBuffer(std::size_t size) { reserve(size); }
  ~DeviceBuffer() {
    if (data_) cudaFree(data_);  // cudaFree(nullptr) would initialise the device
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept { swap(other); }
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Makes room for `size` objects. Returns true if it allocated new memory, with undefined
  /// content.
  bool reserve(std::size_t size) {
    if (size <= size_) return false;
    cudaFree(data_);
    data_ = nullptr;
    size_ = 0;
    check(cudaMalloc(&data_, size * sizeof(T)), "reserving memory");
    size_ = size;
    return true;
  }
  T* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  void swap(DeviceBuffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Page-locked host memory, which the device copies directly.
template <class T>
class PinnedBuffer {
 public:
  PinnedBuffer() = default;
  explicit PinnedBuffer(std::size_t size) { reserve(size); }
  ~PinnedBuffer() {
    if (data_) cudaFreeHost(data_);
  }
  PinnedBuffer(const PinnedBuffer&) = delete;
  PinnedBuffer& operator=(const PinnedBuffer&) = delete;

  /// Makes room for `size` objects; growing loses the content.
  void reserve(std::size_t size) {
    if (size <= size_) return;
    cudaFreeHost(data_);
    data_ = nullptr;
    size_ = 0;
    check(cudaMallocHost(&data_, size * sizeof(T)), "reserving page-locked memory");
    size_ = size;
  }
  T* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Returns true if the device can start a kernel while the previous one still runs.
inline bool overlaps_launches(const DeviceLimits& limits) {
  return limits.compute_capability >= 90;
}

/// Returns true if wait_for_previous() works in the kernel code that the current device runs. It
/// does not in code built for devices before 9.0, on any device.
inline bool waits_for_previous(const void* kernel) {
  int device = 0;
  check(cudaGetDevice(&device), "asking for the device");
  thread_local std::map<std::pair<int, const void*>, bool> known;
  const auto [it, is_new] = known.try_emplace({device, kernel}, false);
  if (is_new) {
    cudaFuncAttributes attributes = {};
    check(cudaFuncGetAttributes(&attributes, kernel), "asking for a kernel's properties");
    it->second = attributes.ptxVersion >= 90;
  }
  return it->second;
}

/// Enqueues a kernel. With `overlap` it may start before the previous kernel of the stream has
/// ended; it must then call wait_for_previous() before it touches that kernel's results.
template <class... Parameters, class... Arguments>
void launch(void (*kernel)(Parameters...), dim3 grid, dim3 block, std::size_t shared_bytes,
            Stream stream, bool overlap, Arguments&&... arguments) {
  cudaLaunchConfig_t config = {};
  config.gridDim = grid;
  config.blockDim = block;
  config.dynamicSmemBytes = shared_bytes;
  config.stream = native(stream);
  cudaLaunchAttribute attribute = {};
  attribute.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  attribute.val.programmaticStreamSerializationAllowed = 1;
  config.attrs = &attribute;
  config.numAttrs = overlap && waits_for_previous(reinterpret_cast<const void*>(kernel)) ? 1 : 0;
  check(cudaLaunchKernelEx(&config, kernel, std::forward<Arguments>(arguments)...),
        "launching a kernel");
}

/// Enqueues a cooperative kernel, whose blocks wait for one another. Throws DeviceError unless all
/// blocks fit on the device at once (blocks_at_once()). It does not start early.
template <class... Parameters, class... Arguments>
void launch_together(void (*kernel)(Parameters...), dim3 grid, dim3 block, std::size_t shared_bytes,
                     Stream stream, Arguments&&... arguments) {
  cudaLaunchConfig_t config = {};
  config.gridDim = grid;
  config.blockDim = block;
  config.dynamicSmemBytes = shared_bytes;
  config.stream = native(stream);
  cudaLaunchAttribute attribute = {};
  attribute.id = cudaLaunchAttributeCooperative;
  attribute.val.cooperative = 1;
  config.attrs = &attribute;
  config.numAttrs = 1;
  check(cudaLaunchKernelEx(&config, kernel, std::forward<Arguments>(arguments)...),
        "launching a kernel");
}

/// Returns how many blocks of a kernel fit on the current device at once; 0 without cooperative
/// launch.
template <class... Parameters>
std::int64_t blocks_at_once(void (*kernel)(Parameters...), int threads, std::size_t shared_bytes,
                            int multiprocessors) {
  int device = 0, together = 0, each = 0;
  check(cudaGetDevice(&device), "asking for the device");
  check(cudaDeviceGetAttribute(&together, cudaDevAttrCooperativeLaunch, device),
        "asking what the device can do");
  if (together == 0) return 0;
  check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, kernel, threads, shared_bytes),
        "asking how many blocks fit");
  return std::int64_t{each} * multiprocessors;
}

#ifdef __CUDACC__
/// Waits until all writes of the previous kernels are visible in the L2 cache. If kernels start
/// early, read data that changes between launches with __ldcg(): a multiprocessor's own cache may
/// hold older values.
__device__ __forceinline__ void wait_for_previous() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}
/// Lets the next kernel start; its own wait still covers this one's results. Call it after
/// wait_for_previous(). Then code before the next kernel's wait already sees what the previous
/// kernel wrote.
__device__ __forceinline__ void let_next_start() {
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}
#endif

}  // namespace hypotrack::cuda
