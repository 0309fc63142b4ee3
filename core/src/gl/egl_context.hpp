#pragma once

#include <string>

namespace hypotrack::gl {

/// An OpenGL core context (3.3 or newer) without a window. Tried in this order: NVIDIA's devices,
/// other graphics devices, software devices, Mesa's surfaceless platform. The displays belong to
/// the process and are never closed, since other contexts may live on them.
class Context {
 public:
  /// Throws DeviceError, listing what was tried and why it failed.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Vendor, renderer and version as OpenGL tells them.
  const std::string& device() const { return device_; }

 private:
  friend class CurrentContext;
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string device_;
};

/// Makes a context the calling thread's current one for the life of this object and gives the
/// thread its former context back afterwards, so that a context can be used from one thread after
/// another.
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

}  // namespace hypotrack::gl
