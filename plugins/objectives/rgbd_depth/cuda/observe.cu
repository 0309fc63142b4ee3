#include <algorithm>

#include "cuda/observe_job.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::rgbd_depth {
namespace {

constexpr int kThreads = 256;

__device__ ViewedPixel viewed(const cuda::TileLayout& tile, int i) {
  const std::uint32_t word = tile.pixels[i];
  return {(word & cuda::kValidFlag) != 0,
          (word & cuda::kForegroundFlag) != 0,
          tile.depth[i],
          static_cast<int>(word & 0xff),
          static_cast<int>(word >> 8 & 0xff),
          static_cast<int>(word >> 16 & 0xff)};
}

/// Separates foreground and background, with a row of blocks per view.
__global__ void __launch_bounds__(kThreads) observe(const __grid_constant__ ObserveJob job) {
  const ViewJob& view = job.views[blockIdx.y];
  const int i = static_cast<int>(blockIdx.x * kThreads + threadIdx.x);
  float observed = kOutside;
  if (i < view.tile.width * view.tile.height) {
    observed = observed_at(viewed(view.tile, i), view.rule, view.range);
    view.observed[i] = observed;
  }
  const bool measured = observed > 0.0f;
  const int foreground_count = __syncthreads_count(measured || observed == kUnmeasured);
  const int measured_count = __syncthreads_count(measured);
  if (threadIdx.x > 0) return;
  // Integer sums do not depend on the order of blocks.
  atomicAdd(&job.counts->foreground, static_cast<std::uint32_t>(foreground_count));
  atomicAdd(&job.counts->measured, static_cast<std::uint32_t>(measured_count));
}

}  // namespace

void enqueue_observe(const ObserveJob& job, cuda::Stream stream) {
  cuda::check(cudaMemsetAsync(job.counts, 0, sizeof(Counts), cuda::native(stream)),
              "clearing memory");
  int most = 0;
  for (int i = 0; i < job.view_count; ++i) {
    const cuda::TileLayout& tile = job.views[static_cast<std::size_t>(i)].tile;
    most = std::max(most, tile.width * tile.height);
  }
  const dim3 blocks(static_cast<unsigned>((most + kThreads - 1) / kThreads),
                    static_cast<unsigned>(job.view_count));
  cuda::launch(observe, blocks, kThreads, 0, stream, false, job);
}

}  // namespace hypotrack::rgbd_depth
