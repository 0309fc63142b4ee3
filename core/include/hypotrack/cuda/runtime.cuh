#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/error.hpp"

/// The few lines of the CUDA runtime that every device plugin needs. Also for C++ sources that see
/// the toolkit's headers.
namespace hypotrack::cuda {

/// Throws DeviceError if a call failed: `doing` says what was being done.
inline void check(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  (void)cudaGetLastError();  // a failed launch is reported once
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

inline cudaStream_t native(Stream stream) { return static_cast<cudaStream_t>(stream.handle); }

/// Device memory for `size()` objects of T; never shrinks.
template <class T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  explicit DeviceBuffer(std::size_t size) { reserve(size); }
  ~DeviceBuffer() {
    if (data_) cudaFree(data_);  // freeing nothing would open the device
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept { swap(other); }
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Room for `size` objects; true if the memory is a new one (its content is then undefined).
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

/// Host memory that the device copies from and to without detours.
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

  /// Room for `size` objects; their content is lost if there was less.
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

/// Whether the device can start a kernel while the one before it still runs.
inline bool overlaps_launches(const DeviceLimits& limits) {
  return limits.compute_capability >= 90;
}

/// Whether wait_for_previous() does something in the code of a kernel that the current device runs:
/// not if that was made from code for devices before 9.0, whatever the device.
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

/// Enqueues a kernel. With `overlap` it may start before the kernel in front of it on the stream
/// has ended, and must call wait_for_previous() before it touches what that one writes.
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

/// The same for a kernel whose blocks wait for one another, so that all of them must be on the
/// device at once: fails where they do not fit (blocks_at_once()). It does not start early.
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

/// How many blocks of a kernel fit on the current device at once; 0 if it cannot promise that.
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
/// Waits until everything that the kernels before wrote is visible: in the L2 cache. Where kernels
/// start early, read what changes from launch to launch with __ldcg(): a multiprocessor's own cache
/// may still hold what a kernel before the last one read.
__device__ __forceinline__ void wait_for_previous() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}
/// Lets the next kernel start; it still waits for this one's results. Call it after
/// wait_for_previous(): then what runs in front of the next kernel's wait finds what the kernel
/// before this one wrote.
__device__ __forceinline__ void let_next_start() {
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}
#endif

}  // namespace hypotrack::cuda
