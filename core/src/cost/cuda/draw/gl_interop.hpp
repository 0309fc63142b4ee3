#pragma once

#include <cstdint>
#include <string>

#include "base/exported.hpp"
#include "cost/gl/egl_layers.hpp"
#include "hypotrack/gpu/device_objective.hpp"

struct cudaGraphicsResource;

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns why CUDA device `index` cannot read what an OpenGL context draws; empty if it can.
std::string why_not_shared(const gl::Context& context, int index);

/// Texture layers that OpenGL draws to and CUDA reads. Their device must be the calling thread's.
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
  cudaGraphicsResource* resource_ = nullptr;  // must be released before the texture
};

/// Maps layers for CUDA, once OpenGL's earlier commands are done; the context must be current.
/// OpenGL must not access them during this object's lifetime. The destructor waits for the stream.
class MappedLayers {
 public:
  MappedLayers(const SharedLayers& layers, Stream stream);
  ~MappedLayers();
  MappedLayers(const MappedLayers&) = delete;
  MappedLayers& operator=(const MappedLayers&) = delete;

  /// Returns a layered cudaTextureObject_t; texel (x, y) is at (x + 0.5, y + 0.5).
  std::uint64_t texture() const { return texture_; }

 private:
  cudaGraphicsResource* resource_;
  Stream stream_;
  std::uint64_t texture_ = 0;
};

}  // namespace internal
}  // namespace hypotrack::cuda
