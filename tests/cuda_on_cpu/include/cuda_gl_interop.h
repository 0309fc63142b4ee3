#pragma once

#include <cuda_runtime.h>

/// OpenGL's pictures cannot be read by kernels on the CPU: asking for its devices says so, and
/// nothing else of this is reached.
using cudaGraphicsResource_t = struct cudaGraphicsResource*;
using cudaMipmappedArray_t = struct cudaMipmappedArray*;
using cudaArray_t = struct cudaArray*;
using cudaTextureObject_t = unsigned long long;
enum cudaGLDeviceList { cudaGLDeviceListAll };
enum cudaResourceType { cudaResourceTypeArray };
enum cudaTextureAddressMode { cudaAddressModeClamp };
enum cudaTextureFilterMode { cudaFilterModePoint };
enum cudaTextureReadMode { cudaReadModeElementType };
inline constexpr unsigned cudaGraphicsRegisterFlagsReadOnly = 1;
struct cudaResourceDesc {
  cudaResourceType resType;
  struct {
    struct {
      cudaArray_t array;
    } array;
  } res;
};
struct cudaTextureDesc {
  cudaTextureAddressMode addressMode[3];
  cudaTextureFilterMode filterMode;
  cudaTextureReadMode readMode;
};

inline cudaError_t cudaGLGetDevices(unsigned*, int*, unsigned, cudaGLDeviceList) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGraphicsGLRegisterImage(cudaGraphicsResource_t*, unsigned, unsigned,
                                               unsigned) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource_t) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGraphicsMapResources(int, cudaGraphicsResource_t*, cudaStream_t) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGraphicsUnmapResources(int, cudaGraphicsResource_t*, cudaStream_t) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGraphicsResourceGetMappedMipmappedArray(cudaMipmappedArray_t*,
                                                               cudaGraphicsResource_t) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaGetMipmappedArrayLevel(cudaArray_t*, cudaMipmappedArray_t, unsigned) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaCreateTextureObject(cudaTextureObject_t*, const cudaResourceDesc*,
                                           const cudaTextureDesc*, const void*) {
  return cudaErrorNotSupported;
}
inline cudaError_t cudaDestroyTextureObject(cudaTextureObject_t) { return cudaErrorNotSupported; }
