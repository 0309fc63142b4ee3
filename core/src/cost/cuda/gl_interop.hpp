#pragma once

#include <cstdint>
#include <string>

#include "cost/gl/egl_layers.hpp"
#include "hypotrack/cuda/device_objective.hpp"

struct cudaGraphicsResource;

namespace hypotrack::cuda {

/// Why CUDA's device `index` cannot read what an OpenGL context draws; empty if it can.
std::string why_not_shared(const gl::Context& context, int index);

/// Layers that OpenGL draws to and CUDA reads. The device must be the calling thread's one.
class SharedLayers {
 public:
  /// The context must outlive it. Throws DeviceError if there is not enough memory.
  SharedLayers(const gl::Context& context, const LayerSize& size);
  ~SharedLayers();
  SharedLayers(const SharedLayers&) = delete;
  SharedLayers& operator=(const SharedLayers&) = delete;

  const EglLayers& layers() const { return layers_; }
  cudaGraphicsResource* resource() const { return resource_; }

 private:
  const gl::Context& context_;
  EglLayers layers_;
  cudaGraphicsResource* resource_ = nullptr;  // ends before the texture does
};

/// The layers in the hands of CUDA, once OpenGL is done with what it was told before; the context
/// must be current. OpenGL must not touch them until the end of this object's life, which waits for
/// the stream.
class MappedLayers {
 public:
  MappedLayers(const SharedLayers& layers, Stream stream);
  ~MappedLayers();
  MappedLayers(const MappedLayers&) = delete;
  MappedLayers& operator=(const MappedLayers&) = delete;

  /// A layered cudaTextureObject_t: texel (x, y) is at (x + 0.5, y + 0.5).
  std::uint64_t texture() const { return texture_; }

 private:
  cudaGraphicsResource* resource_;
  Stream stream_;
  std::uint64_t texture_ = 0;
};

}  // namespace hypotrack::cuda
