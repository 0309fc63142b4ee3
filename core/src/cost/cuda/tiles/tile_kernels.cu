#include "cost/cuda/tiles/tile_kernels.hpp"

#include <algorithm>

#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr int kSide = 16;         // side of the square of pixels per thread block
constexpr int kWide = kSide + 2;  // including a margin of one pixel

__global__ void __launch_bounds__(kSide* kSide)
    reduce(const __grid_constant__ FrameResampling frame) {
  let_next_start();
  const ViewResampling& view = frame.views[blockIdx.z];
  const int column = static_cast<int>(blockIdx.x) * kSide + static_cast<int>(threadIdx.x);
  const int row = static_cast<int>(blockIdx.y) * kSide + static_cast<int>(threadIdx.y);
  const int columns = view.touched.width / view.blocks;
  const int rows = view.touched.height / view.blocks;
  if (!view.means || column >= columns || row >= rows) return;
  view.means[row * columns + column] = block_mean(view, column, row);
}

/// Writes the frame's layout with a whole thread block.
__device__ void write_layout(const FrameResampling& frame, int thread) {
  static_assert(sizeof(FrameLayout) % sizeof(uint4) == 0);
  constexpr int kPieces = sizeof(FrameLayout) / sizeof(uint4);
  const auto* from = reinterpret_cast<const uint4*>(&frame.layout);
  auto* to = reinterpret_cast<uint4*>(frame.layout_to);
  for (int i = thread; i < kPieces; i += kSide * kSide) to[i] = from[i];
}

__global__ void __launch_bounds__(kSide* kSide)
    resample(const __grid_constant__ FrameResampling frame) {
  __shared__ ImagePoint points[kWide][kWide];
  const ViewResampling& view = frame.views[blockIdx.z];
  const int u0 = static_cast<int>(blockIdx.x) * kSide;
  const int v0 = static_cast<int>(blockIdx.y) * kSide;
  const int thread = static_cast<int>(threadIdx.y * kSide + threadIdx.x);
  for (int i = thread; i < kWide * kWide; i += kSide * kSide) {
    const int column = u0 + i % kWide - 1;
    const int row = v0 + i / kWide - 1;
    points[i / kWide][i % kWide] =
        image_point(view.lens, view.camera, static_cast<float>(column), static_cast<float>(row));
  }
  if (blockIdx.x == 0 && blockIdx.y == 0 && blockIdx.z == 0) write_layout(frame, thread);
  __syncthreads();
  wait_for_previous();
  let_next_start();
  const int u = u0 + static_cast<int>(threadIdx.x);
  const int v = v0 + static_cast<int>(threadIdx.y);
  if (u >= view.width || v >= view.height) return;
  const auto map = [&](int column, int row) { return points[row - v0 + 1][column - u0 + 1]; };
  view.tile_pixels[v * view.width + u] = tile_pixel(view, map, u, v);
  if (view.tile_depth) view.tile_depth[v * view.width + u] = tile_depth(view, map(u, v), u, v);
}

unsigned groups(int count) { return static_cast<unsigned>((count + kSide - 1) / kSide); }

}  // namespace

void enqueue_resampling(const FrameResampling& frame, const DeviceLimits& limits, Stream stream) {
  int columns = 0, rows = 0, width = 0, height = 0;
  for (int i = 0; i < frame.view_count; ++i) {
    const ViewResampling& view = frame.views[i];
    if (view.means) {
      columns = std::max(columns, view.touched.width / view.blocks);
      rows = std::max(rows, view.touched.height / view.blocks);
    }
    width = std::max(width, view.width);
    height = std::max(height, view.height);
  }
  const auto views = static_cast<unsigned>(frame.view_count);
  const dim3 square(kSide, kSide);
  const bool reduces = columns > 0;
  if (reduces) {
    launch(reduce, dim3(groups(columns), groups(rows), views), square, 0, stream, false, frame);
  }
  launch(resample, dim3(groups(width), groups(height), views), square, 0, stream,
         reduces && overlaps_launches(limits), frame);
}

}  // namespace hypotrack::cuda::internal
