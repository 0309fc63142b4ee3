#include "cost/cuda/draw/gl_interop.hpp"

// clang-format off
#include <epoxy/gl.h>  // before CUDA's header, which would include another one
#include <cuda_gl_interop.h>
// clang-format on
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gl/egl_context.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

cudaTextureObject_t make_texture(cudaGraphicsResource_t resource) {
  cudaMipmappedArray_t levels = nullptr;
  check(cudaGraphicsResourceGetMappedMipmappedArray(&levels, resource),
        "finding what OpenGL has drawn");
  cudaResourceDesc what = {};
  what.resType = cudaResourceTypeArray;
  check(cudaGetMipmappedArrayLevel(&what.res.array.array, levels, 0),
        "finding what OpenGL has drawn");
  cudaTextureDesc how = {};
  how.addressMode[0] = how.addressMode[1] = cudaAddressModeClamp;
  how.filterMode = cudaFilterModePoint;
  how.readMode = cudaReadModeElementType;
  cudaTextureObject_t texture = 0;
  check(cudaCreateTextureObject(&texture, &what, &how, nullptr), "making a texture");
  return texture;
}

}  // namespace

std::string why_not_shared(const gl::Context& context, int index) {
  const gl::CurrentContext current(context);
  std::array<int, 64> devices{};
  unsigned count = 0;
  const cudaError_t status =
      cudaGLGetDevices(&count, devices.data(), devices.size(), cudaGLDeviceListAll);
  if (status != cudaSuccess) {
    (void)cudaGetLastError();
    return fmt::format("OpenGL ({}) does not draw on a GPU that CUDA sees: {}", context.device(),
                       cudaGetErrorString(status));
  }
  const auto* end = devices.data() + count;
  if (std::find<const int*>(devices.data(), end, index) != end) return {};
  return fmt::format("OpenGL draws on the GPU number {}, not on {}", devices[0], index);
}

SharedLayers::SharedLayers(const gl::Context& context, const LayerSize& size)
    : context_(context), layers_(context, size) {
  const gl::CurrentContext current(context);
  check(cudaGraphicsGLRegisterImage(&resource_, layers_.texture(), GL_TEXTURE_2D_ARRAY,
                                    cudaGraphicsRegisterFlagsReadOnly),
        "sharing memory with OpenGL");
}

SharedLayers::~SharedLayers() {
  const gl::CurrentContext current(context_);
  cudaGraphicsUnregisterResource(resource_);
}

MappedLayers::MappedLayers(const SharedLayers& layers, Stream stream)
    : resource_(layers.resource()), stream_(stream) {
  // Mapping should wait for OpenGL by itself. But with driver 580.159 it hung half the time; after
  // glFinish() it only rarely fails.
  glFinish();
  check(cudaGraphicsMapResources(1, &resource_, native(stream)), "taking over from OpenGL");
  try {
    texture_ = make_texture(resource_);
  } catch (...) {
    cudaGraphicsUnmapResources(1, &resource_, native(stream));
    throw;
  }
}

MappedLayers::~MappedLayers() {
  cudaStreamSynchronize(native(stream_));  // kernels may still read the layers
  cudaDestroyTextureObject(texture_);
  cudaGraphicsUnmapResources(1, &resource_, native(stream_));
}

}  // namespace hypotrack::cuda::internal
