#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns why this machine cannot use the GPU backend: built without CUDA, no driver, driver too
/// old, or no such device. Empty if it can.
std::string why_no_device(int index = 0);

/// Returns why this GPU cannot be used although why_no_device() is empty: it does not answer, or
/// hypotrack was not built for it. Empty if it can. Takes some of the GPU's memory.
std::string why_not_this_device(int index);

/// Claims a GPU for this process (base/machine.hpp). Returns false if another hypotrack uses it, so
/// that the two take turns.
bool claim_gpu(int index);

/// Returns the free bytes of a GPU's memory, or nothing if there is no such GPU or it does not
/// answer. Makes it the GPU of this thread.
std::optional<std::size_t> free_memory(int index = 0);

/// Waits until the GPU of this thread has finished all its work. Throws DeviceError.
void wait_for_device();

/// Keeps the calling thread's GPU: gives it back at the end, whatever was made current since.
class KeepDevice {
 public:
  KeepDevice();
  ~KeepDevice();
  KeepDevice(const KeepDevice&) = delete;
  KeepDevice& operator=(const KeepDevice&) = delete;

 private:
  int before_ = -1;  ///< -1: unknown
};

/// A GPU and the stream for all work of one cost.
class Device {
 public:
  /// Makes `index` the GPU of this thread. Throws DeviceError with the reason of why_no_device() or
  /// why_not_this_device(), if there is one.
  explicit Device(int index);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Stream stream() const { return stream_; }
  const DeviceLimits& limits() const { return limits_; }
  int index() const { return index_; }
  /// Returns the device's name: `NVIDIA H200`.
  const std::string& name() const { return name_; }
  /// Makes it the GPU of the calling thread again.
  void use() const;

 private:
  int index_;
  Stream stream_;
  DeviceLimits limits_;
  std::string name_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
