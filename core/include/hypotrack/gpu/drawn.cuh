#pragma once

#include <concepts>
#include <type_traits>

#include "hypotrack/gpu/bands.cuh"
#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/pixel_residuals.cuh"
#include "hypotrack/gpu/pose.cuh"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/gpu/score.cuh"

/// Scores hypotheses that were drawn before. Several blocks share the rows of a hypothesis.
namespace hypotrack::cuda {

inline constexpr int kDrawnThreads = 512;

/// Inverse depth in a layered texture, with one layer per hypothesis and view.
struct TextureTile {
  cudaTextureObject_t texture;
  int layer;
  __device__ __forceinline__ float inside(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float in_row(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float operator()(int x, int y) const {
    return tex2DLayered<float>(texture, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                               layer);
  }
};

/// Inverse depth in device memory, written by a kernel of the same stream.
struct MemoryTile {
  const float* depth;
  int width;
  __device__ __forceinline__ float inside(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float in_row(int x, int y) const { return (*this)(x, y); }
  __device__ __forceinline__ float operator()(int x, int y) const {
    return __ldcg(depth + y * width + x);
  }
};

/// Returns the number of pixels of all views before one.
__host__ __device__ inline int pixels_before(const FrameLayout& frame, int view) {
  int sum = 0;
  for (int v = 0; v < view; ++v) sum += frame.views[v].width * frame.views[v].height;
  return sum;
}

/// The tiles of one hypothesis of a DrawnBatch, in a texture or in memory.
template <bool kTexture>
struct DrawnTiles {
  const DrawnBatch& drawn;
  const FrameLayout& frame;
  int index;  ///< of the hypothesis, from the first drawn one
  __device__ auto operator()(int view) const {
    if constexpr (kTexture) {
      return TextureTile{drawn.texture, index * frame.view_count + view};
    } else {
      return MemoryTile{drawn.depth + drawn.stride * index + pixels_before(frame, view),
                        frame.views[view].width};
    }
  }
};

/// Calls on_pixel(reference view as a constant, pixel) for the pixels of a stereo Term, or
/// on_pixel(view, pixel) for one of single views. Visits the rows of `band` of `bands`.
template <class Term, class Tiles, class OnPixel>
__device__ __forceinline__ void for_each_drawn_pixel(const Term& term, const FrameLayout& frame,
                                                     const Tiles& tiles, int band, int bands,
                                                     const OnPixel& on_pixel) {
  const auto rows = [&](int v) {
    const ViewLayout& view = frame.views[v];
    return Box{0, view.height * band / bands, view.width, view.height * (band + 1) / bands};
  };
  if constexpr (Term::kStereo) {
    const auto visit = [&](auto reference, auto rectified) {
      constexpr int kReference = decltype(reference)::value;
      const auto here = tiles(kReference), there = tiles(1 - kReference);
      const StereoMap map = frame.maps[kReference];
      for_each_pixel(rows(kReference), [&](int x, int y) {
        on_pixel(reference, stereo_pixel<decltype(rectified)::value>(map, term.tolerance, x, y,
                                                                     here.inside(x, y), there));
      });
    };
    const auto visit_both = [&](auto rectified) {
      if (term.directions() & 1) visit(std::integral_constant<int, 0>(), rectified);
      if (term.directions() & 2) visit(std::integral_constant<int, 1>(), rectified);
    };
    if (frame.pair) {
      visit_both(std::true_type());
    } else {
      visit_both(std::false_type());
    }
  } else {
    for (int v = 0; v < frame.view_count; ++v) {
      if (!(term.views() >> v & 1)) continue;
      const auto here = tiles(v);
      for_each_pixel(rows(v), [&](int x, int y) {
        const float w = here.inside(x, y);
        on_pixel(v, ViewPixel{v, x, y, w, w > 0.0f});
      });
    }
  }
}

/// Adds a pixel to a Term's sums; returns what pixel() returns.
template <class Term, int kReference, class Texels>
__device__ __forceinline__ auto add_drawn(const Term& term, std::integral_constant<int, kReference>,
                                          const StereoPixel& p, const Texels& texels,
                                          float (&sums)[Term::kSums]) {
  return add_pixel<kReference>(term, p, texels, sums);
}
template <class Term, class Texels>
__device__ __forceinline__ auto add_drawn(const Term& term, int, const ViewPixel& p, const Texels&,
                                          float (&sums)[Term::kSums]) {
  return term.pixel(p, sums);
}

__device__ __forceinline__ bool is_covered(const StereoPixel& p) { return !p.uncovered; }
__device__ __forceinline__ bool is_covered(const ViewPixel& p) { return p.covered; }

/// Stores no residuals.
struct NoResiduals {
  template <class... Anything>
  __device__ __forceinline__ void put(Anything...) const {}
};

/// Scores drawn hypotheses, `bands` blocks for each. `To` (ResidualPlaces or NoResiduals) takes the
/// residuals.
template <class Term, class To, bool kTexture>
__global__ void __launch_bounds__(kDrawnThreads)
    score_drawn_hypotheses(const __grid_constant__ SceneLayout scene, const FrameLayout* frame,
                           const __grid_constant__ BatchLayout batch,
                           const __grid_constant__ BlockPlan plan, int bands,
                           const __grid_constant__ DrawnBatch drawn,
                           const __grid_constant__ Term term, const __grid_constant__ To to) {
  constexpr bool kResiduals = std::is_same_v<To, ResidualPlaces>;
  const int index = static_cast<int>(blockIdx.x) / bands;
  const int band = static_cast<int>(blockIdx.x) % bands;
  const std::int64_t hypothesis = std::int64_t{drawn.first} + index;
  wait_for_previous();
  let_next_start();
  if (band == 0) {  // the state, for the Term's cost
    const int size = scene.dimension - (batch.prior ? scene.model_count : 0);
    copy_to_shared(scene.models, scene.model_count, plan.pose.model_layouts);
    load_point(batch.points + hypothesis * size, size, plan.pose);
    __syncthreads();
    decode(scene, *frame, batch.prior, plan.pose);
  }
  float sums[Term::kSums] = {};
  const TileTexels<Term> texels(term, *frame);
  const DrawnTiles<kTexture> tiles{drawn, *frame, index};
  for_each_drawn_pixel(term, *frame, tiles, band, bands, [&](auto view, const auto& p) {
    if (!Term::kVisitsUncovered && !is_covered(p)) {
      if constexpr (kResiduals) {
        const int v = view;
        to.put(hypothesis, v, p.x, p.y,
               term.uncovered_residual(v, p.y * frame->views[v].width + p.x));
      }
      return;
    }
    if constexpr (kResiduals) {
      to.put(hypothesis, view, p.x, p.y, add_drawn(term, view, p, texels, sums));
    } else {
      add_drawn(term, view, p, texels, sums);
    }
  });
  double total[Term::kSums];
  block_sum(sums, shared_floats() + plan.sums, total);  // includes a barrier after the decoding
  if (threadIdx.x >= kWarp) return;
  if (bands > 1) {
    constexpr int kSums = Term::kSums;
    double* slots = plan.band_sums + std::int64_t{index} * (bands * kSums);
    auto* room = reinterpret_cast<double*>(shared_floats() + plan.sums);
    if (!join_bands<kSums>(slots, band, bands, room, total)) return;
  }
  if (threadIdx.x != 0) return;
  const float* state = shared_floats() + plan.pose.state;
  if constexpr (kResiduals && HasStateResiduals<Term>) {
    for (int i = 0; i < term.state_residual_count(); ++i) {
      to.put_state(hypothesis, i, term.state_residual(i, state));
    }
  }
  const double cost = batch.weight * term.cost(total, state);
  double& out = batch.costs[hypothesis];
  out = batch.add ? __ldcg(&out) + cost : cost;
}

/// A Term of single views with slopes of its residuals.
template <class Term>
concept HasViewSlopes = HasResiduals<Term> && requires(const Term& term, const ViewPixel& p) {
  { term.slope(p) } -> std::same_as<float>;
};
/// A stereo Term with slopes of its residuals; texels are those of whole tiles.
template <class Term>
concept HasStereoSlopes = HasResiduals<Term> &&
    requires(const Term& term, const StereoPixel& p, const StereoMap& map,
             const TileTexels<Term>& texels) {
  { term.template slope<0>(p, map, texels) } -> std::same_as<float>;
};
template <class Term>
concept HasSlopes = HasViewSlopes<Term> || HasStereoSlopes<Term>;

template <class Term, int kReference, class Texels>
__device__ __forceinline__ float slope_of(const Term& term, std::integral_constant<int, kReference>,
                                          const StereoPixel& p, const FrameLayout& frame,
                                          const Texels& texels) {
  return term.template slope<kReference>(p, frame.maps[kReference], texels);
}
template <class Term, class Texels>
__device__ __forceinline__ float slope_of(const Term& term, int, const ViewPixel& p,
                                          const FrameLayout&, const Texels&) {
  return term.slope(p);
}

/// Writes the residuals and slopes of drawn hypotheses, one per row of blocks. Blocks share the
/// rows of pixels.
template <class Term>
__global__ void __launch_bounds__(kDrawnThreads)
    write_drawn_slopes(const FrameLayout* frame, const __grid_constant__ DrawnBatch drawn,
                       const __grid_constant__ Term term, SlopeLayout out) {
  wait_for_previous();
  let_next_start();
  const int band = static_cast<int>(blockIdx.x), bands = static_cast<int>(gridDim.x);
  const TileTexels<Term> texels(term, *frame);
  const int index = static_cast<int>(blockIdx.y);
  const DrawnTiles<false> tiles{drawn, *frame, index};
  PixelSlope* const pixels = out.pixels + out.stride * index;
  for_each_drawn_pixel(term, *frame, tiles, band, bands, [&](auto view, const auto& p) {
    const int v = view, i = p.y * frame->views[v].width + p.x;
    PixelSlope at{};
    if (is_covered(p)) {
      float sums[Term::kSums] = {};
      at.residual = add_drawn(term, view, p, texels, sums);
      at.slope = slope_of(term, view, p, *frame, texels);
    } else {
      at.residual = term.uncovered_residual(v, i);
    }
    pixels[pixels_before(*frame, v) + i] = {out.factor * at.residual, out.factor * at.slope};
  });
  for (int v = 0; v < frame->view_count; ++v) {
    if (views_of(term) >> v & 1) continue;
    const int before = pixels_before(*frame, v), all = pixels_before(*frame, v + 1);
    const int step = static_cast<int>(gridDim.x * blockDim.x);
    for (int i = before + static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x); i < all;
         i += step) {
      pixels[i] = {};
    }
  }
}

}  // namespace hypotrack::cuda
