#include "color-inl.hpp"
#include "cuda/feature_job.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::stereo_color {
namespace {

// Pixels of a block, one per thread.
constexpr int kWidth = 32;
constexpr int kHeight = 8;
constexpr int kThreads = kWidth * kHeight;
constexpr float kInvalid = -1.0f;

// Neighbourhood of the block's pixels: grey values two pixels wide, products of gradients one.
struct Surroundings {
  float grey[kHeight + 4][kWidth + 4];
  float xx[kHeight + 2][kWidth + 2], xy[kHeight + 2][kWidth + 2], yy[kHeight + 2][kWidth + 2];
};

__device__ float grey_at(const cuda::TileLayout& tile, int x, int y) {
  if (x < 0 || y < 0 || x >= tile.width || y >= tile.height) return kInvalid;
  const std::uint32_t pixel = tile.pixels[y * tile.width + x];
  return pixel & cuda::kValidFlag ? gray_level(to_bgr(pixel)) : kInvalid;
}

__device__ void load_grey(Surroundings& s, const cuda::TileLayout& tile, int x0, int y0) {
  constexpr int kPitch = kWidth + 4;
  for (int i = static_cast<int>(threadIdx.x); i < (kHeight + 4) * kPitch; i += kThreads) {
    s.grey[i / kPitch][i % kPitch] = grey_at(tile, x0 - 2 + i % kPitch, y0 - 2 + i / kPitch);
  }
}

__device__ float gradient(float before, float after) {
  return before != kInvalid && after != kInvalid ? central_difference(before, after) : 0.0f;
}

__device__ void multiply_gradients(Surroundings& s) {
  constexpr int kPitch = kWidth + 2;
  for (int i = static_cast<int>(threadIdx.x); i < (kHeight + 2) * kPitch; i += kThreads) {
    const int x = i % kPitch, y = i / kPitch;
    const float gx = gradient(s.grey[y + 1][x], s.grey[y + 1][x + 2]);
    const float gy = gradient(s.grey[y][x + 1], s.grey[y + 2][x + 1]);
    s.xx[y][x] = gx * gx;
    s.xy[y][x] = gx * gy;
    s.yy[y][x] = gy * gy;
  }
}

__device__ Texture texture_at(const Surroundings& s, int x, int y) {
  return texture(curvature(sum_3x3(&s.xx[y][x], &s.xx[y + 1][x], &s.xx[y + 2][x]),
                           sum_3x3(&s.xy[y][x], &s.xy[y + 1][x], &s.xy[y + 2][x]),
                           sum_3x3(&s.yy[y][x], &s.yy[y + 1][x], &s.yy[y + 2][x])));
}

__global__ void __launch_bounds__(kThreads) textures(const __grid_constant__ FeatureJob job) {
  __shared__ Surroundings s;
  __shared__ std::uint32_t counts[kQuantities * kBuckets];
  const int thread = static_cast<int>(threadIdx.x);
  for (int i = thread; i < kQuantities * kBuckets; i += kThreads) counts[i] = 0;
  cuda::wait_for_previous();
  cuda::let_next_start();

  const ViewJob& view = job.views[blockIdx.z];
  const int x0 = static_cast<int>(blockIdx.x) * kWidth, y0 = static_cast<int>(blockIdx.y) * kHeight;
  if (x0 >= view.tile.width || y0 >= view.tile.height) return;
  load_grey(s, view.tile, x0, y0);
  __syncthreads();
  multiply_gradients(s);
  __syncthreads();

  const int dx = thread % kWidth, dy = thread / kWidth;
  const int x = x0 + dx, y = y0 + dy;
  if (x < view.tile.width && y < view.tile.height) {
    const bool valid = s.grey[dy + 2][dx + 2] != kInvalid;
    const Texture t = texture_at(s, dx, dy);
    const Key keys[kQuantities] = {__float_as_uint(t.norm), __float_as_uint(t.ratio)};
    for (int q = 0; q < kQuantities; ++q) {
      view.keys[q][y * view.tile.width + x] = valid ? keys[q] : kNoKey;
      if (valid) atomicAdd(&counts[q * kBuckets + (keys[q] >> kBucketShift)], 1u);
    }
  }
  __syncthreads();
  for (int i = thread; i < kQuantities * kBuckets; i += kThreads) {
    if (counts[i] > 0) atomicAdd(view.counts + i, counts[i]);
  }
}

}  // namespace

void enqueue_textures(const FeatureJob& job, cuda::Stream stream, bool overlap) {
  const auto blocks = [](int pixels, int each) {
    return static_cast<unsigned>((pixels + each - 1) / each);
  };
  cuda::launch(&textures, dim3(blocks(job.widest(), kWidth), blocks(job.highest(), kHeight), 2),
               dim3(kThreads), 0, stream, overlap, job);
}

}  // namespace hypotrack::stereo_color
