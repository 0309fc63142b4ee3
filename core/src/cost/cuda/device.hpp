#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::cuda {

/// Why the GPU backend cannot be used on this machine: built without CUDA, no driver, driver too
/// old, no such device. Empty if it can.
HYPOTRACK_API std::string why_no_device(int index = 0);

/// Why this GPU, for which why_no_device() has no reason, cannot be used all the same: it does not
/// answer, or hypotrack was built for other ones. Empty if it can. Takes some of its memory.
std::string why_not_this_device(int index);

/// Bytes of a GPU's memory that no process uses; nothing where there is no such GPU or it does not
/// answer. Makes it the GPU of this thread.
HYPOTRACK_API std::optional<std::size_t> free_memory(int index = 0);

/// A GPU and the stream that everything of one evaluator is enqueued on.
class HYPOTRACK_API Device {
 public:
  /// Makes `index` the GPU of this thread. Throws DeviceError where one of the two has a reason.
  explicit Device(int index);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Stream stream() const { return stream_; }
  const DeviceLimits& limits() const { return limits_; }
  /// `NVIDIA H200`
  const std::string& name() const { return name_; }
  /// Makes it the GPU of the calling thread again.
  void use() const;

 private:
  int index_;
  Stream stream_;
  DeviceLimits limits_;
  std::string name_;
};

}  // namespace hypotrack::cuda
