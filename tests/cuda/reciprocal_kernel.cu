#include "reciprocal_kernel.hpp"

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::test {
namespace {

constexpr unsigned kThreads = 256;

__global__ void reciprocals(std::uint32_t first, std::uint32_t count, float* out) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i < count) out[i] = cuda::exact_reciprocal(__uint_as_float(first + i));
}

}  // namespace

std::vector<float> exact_reciprocals(std::uint32_t first, std::uint32_t count) {
  cuda::DeviceBuffer<float> buffer;
  buffer.reserve(count);
  cuda::launch(&reciprocals, (count + kThreads - 1) / kThreads, kThreads, 0, {}, false, first,
               count, buffer.data());
  std::vector<float> out(count);
  cuda::check(cudaMemcpy(out.data(), buffer.data(), count * sizeof(float), cudaMemcpyDeviceToHost),
              "finding reciprocals");
  return out;
}

}  // namespace hypotrack::test
