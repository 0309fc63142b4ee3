#pragma once

#include <memory>

#include "base/exported.hpp"

namespace hypotrack::gl {
inline namespace HYPOTRACK_EXPORTED internal {
class Context;
}
}  // namespace hypotrack::gl

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Size of a texture array.
struct LayerSize {
  int width = 0;
  int height = 0;
  int layers = 0;
};

/// A texture array of floats with a framebuffer that draws to all of its layers.
class EglLayers {
 public:
  /// The context must outlive it. Throws DeviceError if there is not enough memory.
  EglLayers(const gl::Context& context, const LayerSize& size);
  ~EglLayers();
  EglLayers(const EglLayers&) = delete;
  EglLayers& operator=(const EglLayers&) = delete;

  /// Returns true if a drawing of this size fits.
  bool holds(const LayerSize& size) const;

  /// Returns the name of the GL_TEXTURE_2D_ARRAY (R32F).
  unsigned texture() const;

  /// Binds it as the render target and clears every layer to 0; the context must be current.
  void begin() const;
  /// Copies the first `layers` layers to memory, consecutively and row by row without gaps.
  void read(int layers, float* pixels) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
