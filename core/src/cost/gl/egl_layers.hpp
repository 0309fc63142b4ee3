#pragma once

#include <memory>

namespace hypotrack {

namespace gl {
class Context;
}

/// Extent of a texture array.
struct LayerSize {
  int width = 0;
  int height = 0;
  int layers = 0;
};

/// A texture array of floats, all layers of which can be drawn to at once.
class EglLayers {
 public:
  /// The context must outlive it. Throws DeviceError if there is not enough memory.
  EglLayers(const gl::Context& context, const LayerSize& size);
  ~EglLayers();
  EglLayers(const EglLayers&) = delete;
  EglLayers& operator=(const EglLayers&) = delete;

  /// Whether something of this size can be drawn to the first of its layers.
  bool holds(const LayerSize& size) const;

  /// Name of the GL_TEXTURE_2D_ARRAY (R32F).
  unsigned texture() const;

  /// Makes it what is drawn to and sets every layer to 0; the context must be current.
  void begin() const;
  /// Copies the first `layers` layers, one after the other and row by row without gaps.
  void read(int layers, float* pixels) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
