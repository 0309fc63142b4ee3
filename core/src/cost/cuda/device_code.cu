#include "cost/cuda/device_code.hpp"

#include <cuda_runtime.h>

namespace hypotrack::cuda::internal {
namespace {

__global__ void probe() {}

}  // namespace

bool has_code_for_current_device() {
  cudaFuncAttributes attributes = {};
  if (cudaFuncGetAttributes(&attributes, probe) == cudaSuccess) return true;
  (void)cudaGetLastError();
  return false;
}

}  // namespace hypotrack::cuda::internal
