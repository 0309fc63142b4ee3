#include "color-inl.hpp"
#include "cuda/feature_job.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::stereo_color {
namespace {

constexpr int kThreads = 256;

__device__ Channels channels(const FeatureJob& job, Bgr bgr) {
  switch (job.color_space) {
    case ColorSpace::gray:
      return {gray_level(bgr), 0.0f, 0.0f};
    case ColorSpace::hsv:
      return on_cone(to_hsv(rgb_channels(bgr)));
    case ColorSpace::lab:
      return to_lab(bgr, job.lab_nodes);
    default:
      return with_gray_share(rgb_channels(bgr), job.gray_weight);
  }
}

__device__ float weight(const FeatureJob& job, const ViewJob& view, int i, std::uint32_t pixel) {
  const std::uint32_t needed =
      cuda::kValidFlag | (view.masked ? cuda::kForegroundFlag : std::uint32_t{0});
  if ((pixel & needed) != needed) return 0.0f;
  if (!job.weighted) return 1.0f;
  const Texture t{__uint_as_float(view.keys[0][i]), __uint_as_float(view.keys[1][i])};
  return distinctiveness(t, medians(view.medians[0], view.medians[1]), job.w_t);
}

// May read the pixels while the kernel `select_medians` still runs, which itself waited for the end
// of the first kernel. The results of `select_medians` need a wait.
__global__ void __launch_bounds__(kThreads) features(const __grid_constant__ FeatureJob job) {
  const ViewJob& view = job.views[blockIdx.y];
  const int i = static_cast<int>(blockIdx.x * kThreads + threadIdx.x);
  const bool inside = i < view.tile.width * view.tile.height;
  if (!job.weighted) cuda::wait_for_previous();
  const std::uint32_t pixel = inside ? __ldcg(view.tile.pixels + i) : 0;
  const Channels c = channels(job, to_bgr(pixel));
  if (job.weighted) cuda::wait_for_previous();
  cuda::let_next_start();
  if (!inside) return;
  view.features[i] = {pack_unorm16(c.c0, c.c1), pack_unorm16(c.c2, weight(job, view, i, pixel))};
}

}  // namespace

void enqueue_features(const FeatureJob& job, cuda::Stream stream, bool overlap) {
  const auto pixels = static_cast<unsigned>(job.widest() * job.highest());
  cuda::launch(&features, dim3((pixels + kThreads - 1) / kThreads, 2), dim3(kThreads), 0, stream,
               overlap, job);
}

}  // namespace hypotrack::stereo_color
