#include "cost/cuda/device.hpp"

#include <fmt/format.h>

#include <array>

#include "base/machine.hpp"
#include "cost/cuda/device_code.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

std::string version_text(int version) {
  return fmt::format("{}.{}", version / 1000, version % 1000 / 10);
}

}  // namespace

std::string why_no_device(int index) {
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess) (void)cudaGetLastError();
  if (status == cudaErrorInsufficientDriver) {
    int driver = 0;
    if (cudaDriverGetVersion(&driver) != cudaSuccess || driver == 0)
      return "there is no NVIDIA driver";
    return fmt::format(
        "the NVIDIA driver is too old: it supports CUDA {}, hypotrack was built with {}",
        version_text(driver), version_text(CUDART_VERSION));
  }
  if (status == cudaErrorNoDevice || (status == cudaSuccess && count == 0)) {
    return "there is no NVIDIA GPU";
  }
  if (status != cudaSuccess) {
    return fmt::format("the NVIDIA driver does not answer: {}", cudaGetErrorString(status));
  }
  if (index < 0 || index >= count) {
    return fmt::format("there is no GPU number {}; this machine has {} (0 to {})", index, count,
                       count - 1);
  }
  return {};
}

std::string why_not_this_device(int index) {
  const cudaError_t status = cudaSetDevice(index);
  if (status != cudaSuccess) {
    (void)cudaGetLastError();
    return fmt::format("GPU number {} does not answer: {}", index, cudaGetErrorString(status));
  }
  if (has_code_for_current_device()) return {};
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, index), "asking for the device's properties");
  return fmt::format(
      "hypotrack was built for other GPUs than {} of compute capability {}.{} (set "
      "CMAKE_CUDA_ARCHITECTURES={}{})",
      properties.name, properties.major, properties.minor, properties.major, properties.minor);
}

bool claim_gpu(int index) {
  std::array<char, 32> address{};  // tells GPUs apart whatever CUDA_VISIBLE_DEVICES says
  const cudaError_t status =
      cudaDeviceGetPCIBusId(address.data(), static_cast<int>(address.size()), index);
  if (status == cudaSuccess) return claim(fmt::format("gpu/{}", address.data()));
  (void)cudaGetLastError();
  return true;
}

std::optional<std::size_t> free_memory(int index) {
  std::size_t free = 0, total = 0;
  const bool known = why_no_device(index).empty() && cudaSetDevice(index) == cudaSuccess &&
                     cudaMemGetInfo(&free, &total) == cudaSuccess;
  if (known) return free;
  (void)cudaGetLastError();
  return std::nullopt;
}

void wait_for_device() { check(cudaDeviceSynchronize(), "waiting for the GPU"); }

// Asking and setting the device that is current already make no context.
KeepDevice::KeepDevice() {
  static const bool has_devices = why_no_device().empty();
  if (has_devices && cudaGetDevice(&before_) != cudaSuccess) before_ = -1;
}

KeepDevice::~KeepDevice() {
  int now = -1;
  if (before_ < 0 || cudaGetDevice(&now) != cudaSuccess || now == before_) return;
  if (cudaSetDevice(before_) != cudaSuccess) (void)cudaGetLastError();  // for no later call
}

Device::Device(int index) : index_(index) {
  std::string why = why_no_device(index);
  if (why.empty()) why = why_not_this_device(index);
  if (!why.empty()) {
    throw DeviceError("evaluate.backend: cuda: " + why +
                      ". Write `backend: cpu`, or `auto` to take what there is");
  }
  use();
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, index), "asking for the device's properties");
  name_ = properties.name;
  limits_.multiprocessors = properties.multiProcessorCount;
  limits_.compute_capability = 10 * properties.major + properties.minor;
  limits_.shared_bytes_per_block = static_cast<int>(properties.sharedMemPerBlockOptin);
  limits_.shared_bytes_per_multiprocessor = static_cast<int>(properties.sharedMemPerMultiprocessor);
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream");
  stream_.handle = stream;
}

Device::~Device() { cudaStreamDestroy(native(stream_)); }

void Device::use() const { check(cudaSetDevice(index_), "choosing the device"); }

}  // namespace hypotrack::cuda::internal
