#include <algorithm>

#include "color_bins.hpp"
#include "cuda/foreground_job.hpp"
#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::skin {
namespace {

constexpr int kThreads = 256;

/// Returns blue, green or red of a pixel.
__device__ int channel(std::uint32_t pixel, int i) {
  return static_cast<int>(pixel >> (8 * i) & 0xFF);
}

__device__ float probability(const ViewJob& view, int i, std::uint32_t pixel) {
  switch (view.rule) {
    case Rule::mask:
      return pixel & cuda::kForegroundFlag ? 1.0f : 0.0f;
    case Rule::depth: {
      const float z = view.tile.depth[i];
      return z > 0 && z >= view.range.nearest && z <= view.range.farthest ? 1.0f : 0.0f;
    }
    default: {
      const int bin = bin_of(channel(pixel, 0), channel(pixel, 1), channel(pixel, 2));
      if (!view.background) return view.probabilities[bin];
      const std::uint32_t background = view.background[i];
      if (background >> 24 == 0) return view.probabilities[bin];
      float square = 0;
      for (int c = 0; c < 3; ++c) {
        const auto apart = static_cast<float>(channel(pixel, c) - channel(background, c));
        square += apart * apart;
      }
      return foreground_before(view.frequencies[bin], square);
    }
  }
}

/// Separates foreground and background, with a row of blocks per view.
__global__ void __launch_bounds__(kThreads) foreground(const __grid_constant__ ForegroundJob job) {
  const ViewJob& view = job.views[blockIdx.y];
  const int i = static_cast<int>(blockIdx.x * kThreads + threadIdx.x);
  std::uint32_t word = 0;
  if (i < view.tile.width * view.tile.height) {
    const std::uint32_t pixel = view.tile.pixels[i];
    if (pixel & cuda::kValidFlag) {
      const float p = probability(view, i, pixel);
      word = pack_unorm16(p, 1 - p);
    }
    view.pixels[i] = word;
  }
  // Integer sums, below 2^24 in a warp, do not depend on the order of blocks.
  const float sum = cuda::warp_sum(static_cast<float>(word & 0xFFFF));
  if (threadIdx.x % cuda::kWarp == 0 && sum > 0) {
    atomicAdd(job.sum, static_cast<unsigned long long>(sum));
  }
}

}  // namespace

void enqueue_foreground(const ForegroundJob& job, cuda::Stream stream) {
  cuda::check(cudaMemsetAsync(job.sum, 0, sizeof *job.sum, cuda::native(stream)),
              "clearing memory");
  int most = 0;
  for (int i = 0; i < job.view_count; ++i) {
    const cuda::TileLayout& tile = job.views[static_cast<std::size_t>(i)].tile;
    most = std::max(most, tile.width * tile.height);
  }
  const dim3 blocks(static_cast<unsigned>((most + kThreads - 1) / kThreads),
                    static_cast<unsigned>(job.view_count));
  cuda::launch(foreground, blocks, kThreads, 0, stream, false, job);
}

}  // namespace hypotrack::skin
