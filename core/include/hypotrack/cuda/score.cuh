#pragma once

#include "hypotrack/cuda/pixel_walk.cuh"
#include "hypotrack/cuda/texels.cuh"

/// A Term's pixels, looked at by a block of threads.
namespace hypotrack::cuda {

/// Calls pixel(x, y) for the pixels of a box, each by one thread of the block.
template <class Pixel>
__device__ __forceinline__ void for_each_pixel(const Box& box, const Pixel& pixel) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const int warps = static_cast<int>(blockDim.x) / kWarp;
  // Warps stand side by side over a row, as many as it takes, in groups one above the other.
  const int side_by_side = min((box.width() + kWarp - 1) / kWarp, warps);
  if (side_by_side <= 0) return;
  const int groups = small_quotient(warps, side_by_side);
  const int group = small_quotient(warp, side_by_side);
  if (group >= groups) return;
  const int first = box.x0 + (warp - group * side_by_side) * kWarp + lane;
  for (int y = box.y0 + group; y < box.y1; y += groups) {
    for (int x = first; x < box.x1; x += side_by_side * kWarp) {
      pixel(x, y);
    }
  }
}

/// Adds the pixels of `here` within its box to the sums.
template <int kReference, bool kRectified, class Term, class Here, class There, class Texels>
__device__ __forceinline__ void score_stereo(const Term& term, const StereoMap map, const Box& box,
                                             const Here& here, const There& there,
                                             const Texels& texels, float (&sums)[Term::kSums]) {
  for_each_pixel(box, [&](int x, int y) {
    const float w = here.inside(x, y);
    if (!Term::kVisitsUncovered && !(w > 0.0f)) return;
    add_pixel<kReference>(term, stereo_pixel<kRectified>(map, term.tolerance, x, y, w, there),
                          texels, sums);
  });
}

/// Adds the pixels of one view to the sums.
template <class Term, class Here>
__device__ __forceinline__ void score_view(const Term& term, int view, const Box& box,
                                           const Here& here, float (&sums)[Term::kSums]) {
  for_each_pixel(box, [&](int x, int y) {
    const float w = here.inside(x, y);
    if (!Term::kVisitsUncovered && !(w > 0.0f)) return;
    term.pixel(ViewPixel{view, x, y, w, w > 0.0f}, sums);
  });
}

}  // namespace hypotrack::cuda
