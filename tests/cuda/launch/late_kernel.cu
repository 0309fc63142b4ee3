#include "hypotrack/gpu/runtime.cuh"
#include "kernels.hpp"

namespace hypotrack::test {
namespace {

__global__ void write_late_kernel(int* value) {
  cuda::let_next_start();
  const long long start = clock64();
  while (clock64() - start < 2'000'000) {
  }
  *value = 1;
}

}  // namespace

void write_late(int* value, cuda::Stream stream) {
  cuda::launch(&write_late_kernel, dim3(1), dim3(1), 0, stream, false, value);
}

}  // namespace hypotrack::test
