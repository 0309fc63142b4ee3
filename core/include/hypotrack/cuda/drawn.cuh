#pragma once

#include <type_traits>

#include "hypotrack/cuda/block_plan.hpp"
#include "hypotrack/cuda/pose.cuh"
#include "hypotrack/cuda/score.cuh"

/// Scores hypotheses that another component has drawn.
namespace hypotrack::cuda {

/// Inverse depth in a layered texture, with one layer per hypothesis and view.
struct DrawnDepth {
  cudaTextureObject_t texture;
  int layer;
  __device__ __forceinline__ float inside(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float in_row(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float operator()(int x, int y) const {
    return tex2DLayered<float>(texture, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                               layer);
  }
};

/// Scores one drawn hypothesis per block.
template <class Term>
__global__ void __launch_bounds__(kMostThreads)
    score_drawn_hypotheses(const __grid_constant__ SceneLayout scene, const FrameLayout* frame,
                           const __grid_constant__ BatchLayout batch,
                           const __grid_constant__ BlockPlan plan, DrawnBatch drawn,
                           const __grid_constant__ Term term) {
  const int layer = static_cast<int>(blockIdx.x) * frame->view_count;
  const std::int64_t hypothesis = drawn.first + static_cast<std::int64_t>(blockIdx.x);
  const int size = scene.dimension - (batch.prior ? scene.model_count : 0);
  copy_to_shared(scene.models, scene.model_count, plan.pose.model_layouts);
  load_point(batch.points + hypothesis * size, size, plan.pose);
  __syncthreads();
  decode(scene, *frame, batch.prior, plan.pose);
  float sums[Term::kSums] = {};
  const auto tile = [&](int v) { return Box{0, 0, frame->views[v].width, frame->views[v].height}; };
  const auto depth = [&](int v) { return DrawnDepth{drawn.texture, layer + v}; };
  if constexpr (Term::kStereo) {
    const TileTexels<Term> texels(term, *frame);
    const auto score = [&](auto rectified) {
      constexpr bool kRectified = decltype(rectified)::value;
      if (term.directions() & 1) {
        score_stereo<0, kRectified>(term, frame->maps[0], tile(0), depth(0), depth(1), texels,
                                    sums);
      }
      if (term.directions() & 2) {
        score_stereo<1, kRectified>(term, frame->maps[1], tile(1), depth(1), depth(0), texels,
                                    sums);
      }
    };
    if (frame->pair) {
      score(std::true_type());
    } else {
      score(std::false_type());
    }
  } else {
    for (int v = 0; v < frame->view_count; ++v) {
      if (term.views() >> v & 1) score_view(term, v, tile(v), depth(v), sums);
    }
  }
  double total[Term::kSums];
  block_sum(sums, shared_floats() + plan.sums, total);  // includes a barrier after the decoding
  if (threadIdx.x != 0) return;
  const double cost = batch.weight * term.cost(total, shared_floats() + plan.pose.state);
  double& out = batch.costs[hypothesis];
  out = batch.add ? __ldcg(&out) + cost : cost;
}

}  // namespace hypotrack::cuda
