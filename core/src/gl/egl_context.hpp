#pragma once

#include <string>

#include "base/exported.hpp"

namespace hypotrack::gl {
inline namespace HYPOTRACK_EXPORTED internal {

/// An OpenGL core context (3.3 or newer) without a window. It tries NVIDIA's devices (the
/// preferred one first), other graphics devices, software devices and Mesa's surfaceless platform,
/// in this order. The displays belong to the process and are never closed, because other contexts
/// may use them.
class Context {
 public:
  /// Throws DeviceError, which lists what was tried and why it failed.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Returns OpenGL's vendor, renderer and version.
  const std::string& device() const { return device_; }

 private:
  friend class CurrentContext;
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string device_;
};

/// Makes a context current in the calling thread during this object's lifetime, then restores the
/// thread's former context. Several threads can so use one context in turn.
class CurrentContext {
 public:
  /// Throws DeviceError if the context is current in another thread.
  explicit CurrentContext(const Context& context);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  void* display_;
  unsigned former_api_;
  void* former_display_;
  void* former_context_;
  void* former_draw_;
  void* former_read_;
};

/// Makes later contexts of this process draw on an NVIDIA GPU by its number for CUDA, where EGL
/// offers it. The variable HYPOTRACK_GL_GPU goes before.
void prefer_gpu(int number);

/// Throws DeviceError unless as many threads can be started as Mesa's software rasteriser starts:
/// it waits for ever for threads that do not start.
void expect_driver_threads();

}  // namespace internal
}  // namespace hypotrack::gl
