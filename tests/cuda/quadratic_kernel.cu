#include "quadratic_kernel.hpp"

#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::test {
namespace {

constexpr int kThreads = 128;

__global__ void quadratic(const double* target, int dimension, const double* points,
                          std::int64_t count, double* costs) {
  cuda::wait_for_previous();
  cuda::let_next_start();
  if (!target) __trap();
  const std::int64_t i = std::int64_t{blockIdx.x} * kThreads + threadIdx.x;
  if (i >= count) return;
  double sum = 0;
  for (int d = 0; d < dimension; ++d) {
    const double offset = points[i * dimension + d] - target[d];
    sum += (d + 1) * (offset * offset);
  }
  costs[i] = sum;
}

}  // namespace

void enqueue_quadratic(const double* target, int dimension, const double* points,
                       std::int64_t count, double* costs, cuda::Stream stream) {
  const auto blocks = static_cast<unsigned>((count + kThreads - 1) / kThreads);
  cuda::launch(quadratic, blocks, kThreads, 0, stream, true, target, dimension, points, count,
               costs);
}

}  // namespace hypotrack::test
