#pragma once

#include "hypotrack/gpu/pixel_walk.cuh"
#include "hypotrack/gpu/texels.cuh"

/// Visits the pixels of a Term with a block of threads.
namespace hypotrack::cuda {

/// Calls pixel(x, y) once per pixel of a box. Threads take consecutive pixels and continue in the
/// next row, so that all stay busy.
template <class Pixel>
__device__ __forceinline__ void for_each_pixel(const Box& box, const Pixel& pixel) {
  const int width = box.width();
  if (width <= 0) return;
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  const int row = small_quotient(thread, width), rows_on = small_quotient(threads, width);
  const int columns_on = threads - rows_on * width;
  int x = box.x0 + thread - row * width, y = box.y0 + row;
#pragma unroll 1  // keeps the code short
  while (y < box.y1) {
    pixel(x, y);
    x += columns_on;
    y += rows_on;
    if (x >= box.x1) {
      x -= width;
      ++y;
    }
  }
}

/// Adds the reference view's pixels within a box to the sums of a stereo Term.
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

/// Adds one view's pixels within a box to the sums.
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
