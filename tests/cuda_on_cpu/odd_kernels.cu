#include "odd_kernels.hpp"

#include "hypotrack/gpu/bands.cuh"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::test {
namespace {

template <class T>
std::vector<T> downloaded(const cuda::DeviceBuffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  cuda::check(
      cudaMemcpy(values.data(), buffer.data(), values.size() * sizeof(T), cudaMemcpyDeviceToHost),
      "downloading");
  return values;
}

__global__ void sum_by_halves(Barriers barriers, int* out) {
  __shared__ int numbers[1024];
  const int thread = static_cast<int>(threadIdx.x);
  numbers[thread] = thread + 1;
  if (barriers == Barriers::all) __syncthreads();
  for (int half = static_cast<int>(blockDim.x) / 2; half > 0; half /= 2) {
    if (thread < half) numbers[thread] += numbers[thread + half];
    __syncthreads();
  }
  if (thread == 0) *out = numbers[0];
}

__global__ void exchange(int* out, unsigned* multiples) {
  const int lane = static_cast<int>(threadIdx.x);
  out[lane] = __shfl_sync(cuda::kWholeWarp, 10 * lane, 5);
  out[32 + lane] = __shfl_xor_sync(cuda::kWholeWarp, 10 * lane, 1);
  out[64 + lane] = __shfl_up_sync(cuda::kWholeWarp, 10 * lane, 2);
  multiples[lane] = __ballot_sync(cuda::kWholeWarp, lane % 3 == 0);
}

__global__ void hand_over(double* slots, double* sum) {
  if (blockIdx.x > 0) {
    cuda::fill_slot(slots + blockIdx.x, static_cast<double>(blockIdx.x));
    return;
  }
  *sum = 0;
  for (unsigned i = 1; i < gridDim.x; ++i) *sum += cuda::empty_slot(slots + i);
}

__global__ void add_rounded(float a, float b, float* out) {
  out[0] = __fadd_ru(a, b);
  out[1] = __fadd_rd(a, b);
}
__global__ void permute(unsigned low, unsigned high, unsigned selector, unsigned* out) {
  *out = __byte_perm(low, high, selector);
}

__global__ void go_wrong(Mistake mistake, int* out) {
  switch (mistake) {
    case Mistake::trap:
      if (threadIdx.x == 7) __trap();
      break;
    case Mistake::lanes_do_different_things:
      if (threadIdx.x < 16) {
        *out = __shfl_sync(cuda::kWholeWarp, 1, 0);
      } else {
        *out = __any_sync(cuda::kWholeWarp, 1);
      }
      break;
    case Mistake::wait_in_vain:
      if (threadIdx.x < 32) __syncthreads();
      if (threadIdx.x >= 32) __syncwarp();
      if (threadIdx.x == 32) __shfl_sync(cuda::kWholeWarp, 1, 0);
      if (threadIdx.x > 32) __syncthreads();
      break;
  }
}

}  // namespace

int sum_of_block(int threads, Barriers barriers) {
  const cuda::DeviceBuffer<int> out(1);
  cuda::launch(&sum_by_halves, 1, static_cast<unsigned>(threads), 0, {}, false, barriers,
               out.data());
  return downloaded(out)[0];
}

Exchanges exchange_in_warp() {
  const cuda::DeviceBuffer<int> out(96);
  const cuda::DeviceBuffer<unsigned> multiples(32);
  cuda::launch(&exchange, 1, 32, 0, {}, false, out.data(), multiples.data());
  const std::vector<int> all = downloaded(out);
  const auto part = [&](int first) {
    return std::vector<int>(all.begin() + first, all.begin() + first + 32);
  };
  return {part(0), part(32), part(64), downloaded(multiples)};
}

double sum_over_blocks(unsigned blocks) {
  const cuda::DeviceBuffer<double> slots(blocks), sum(1);
  cuda::check(cudaMemset(slots.data(), 0xFF, blocks * sizeof(double)), "emptying slots");
  cuda::launch_together(&hand_over, blocks, 1, 0, {}, slots.data(), sum.data());
  return downloaded(sum)[0];
}

Roundings round_sum(float a, float b) {
  const cuda::DeviceBuffer<float> out(2);
  cuda::launch(&add_rounded, 1, 1, 0, {}, false, a, b, out.data());
  const std::vector<float> sums = downloaded(out);
  return {sums[0], sums[1]};
}

unsigned permute_bytes(unsigned low, unsigned high, unsigned selector) {
  const cuda::DeviceBuffer<unsigned> out(1);
  cuda::launch(&permute, 1, 1, 0, {}, false, low, high, selector, out.data());
  return downloaded(out)[0];
}

cudaError_t run_broken_kernel(Mistake mistake) {
  const cuda::DeviceBuffer<int> out(1);
  cuda::launch(&go_wrong, 1, 64, 0, {}, false, mistake, out.data());
  return cudaDeviceSynchronize();
}

}  // namespace hypotrack::test
