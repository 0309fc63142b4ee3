#pragma once

#include <cuda_pipeline_primitives.h>

#include <cstring>
#include <type_traits>

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/layout.hpp"

/// Per-pixel features that a Term reads from a pair's tiles: `texels.template at<view>(x, y)`.
namespace hypotrack::cuda {

/// A Term that reads a Texel per pixel.
template <class Term>
concept HasTexels = requires {
  typename Term::Texel;
};

/// Texel of a Term that has none.
struct NoTexel {};
template <class Term>
struct TexelOf {
  using Type = NoTexel;
};
template <HasTexels Term>
struct TexelOf<Term> {
  using Type = typename Term::Texel;
};

/// Texels of whole tiles in global memory.
template <class Term>
class TileTexels {
 public:
  using Texel = typename TexelOf<Term>::Type;

  __device__ __forceinline__ TileTexels(const Term& term, const FrameLayout& frame) {
    if constexpr (HasTexels<Term>) {
      for (int v = 0; v < 2; ++v) {
        first_[v] = term.texels(v);
        pitch_[v] = frame.views[v].width;
      }
    }
  }
  template <int kView>
  __device__ __forceinline__ Texel at(int x, int y) const {
    using Words = std::conditional_t<sizeof(Texel) == 16, uint4,
                                     std::conditional_t<sizeof(Texel) == 8, uint2, unsigned>>;
    const Texel* from = first_[kView] + (y * pitch_[kView] + x);
    const Words words = __ldg(reinterpret_cast<const Words*>(from));
    Texel texel;
    std::memcpy(&texel, &words, sizeof texel);
    return texel;
  }

 private:
  const Texel* first_[2];
  int pitch_[2];
};

/// Layout of the texels of a pair of boxes with equal rows in a block's shared memory. Each row
/// holds the columns of both views; rows follow one another. Offsets count texels.
struct TexelLayout {
  bool fits;
  int begin;       ///< offset of the first texel
  int pitch;       ///< texels per row of both views
  int y0, rows;    ///< first tile row and number of rows
  int columns[2];  ///< first tile column of each view
  int in_left;     ///< number of columns of the first view
  int first[2];    ///< offset where the tiles' pixel (0, 0) would be
};

/// Texels of one box per view, with a margin of one column, in the block's shared memory.
template <class Term>
class SharedTexels {
 public:
  using Texel = typename TexelOf<Term>::Type;

  /// Computes the layout of the boxes' texels between offsets `begin` and `end` of shared_floats().
  __device__ __forceinline__ static TexelLayout lay_out(const FrameLayout& frame, const Box& left,
                                                        const Box& right, int begin, int end) {
    TexelLayout layout{};
    if constexpr (HasTexels<Term>) {
      const Columns columns[2] = {Columns(left, frame.views[0].width),
                                  Columns(right, frame.views[1].width)};
      layout.y0 = left.y0;
      layout.rows = left.height();
      layout.in_left = columns[0].count;
      layout.pitch = columns[0].count + columns[1].count;
      layout.begin = begin * 4 / kSize;
      layout.fits = layout.begin + layout.pitch * layout.rows <= end * 4 / kSize;
      const int above = layout.begin - left.y0 * layout.pitch;
      layout.columns[0] = columns[0].first;
      layout.columns[1] = columns[1].first;
      layout.first[0] = above - columns[0].first;
      layout.first[1] = above - columns[1].first + columns[0].count;
    }
    return layout;
  }

  __device__ __forceinline__ explicit SharedTexels(const TexelLayout& layout)
      : first_{layout.first[0], layout.first[1]}, pitch_(layout.pitch) {}

  /// Starts an asynchronous copy of the texels by the whole block, if they fit.
  __device__ __forceinline__ static void fetch(const Term& term, const FrameLayout& frame,
                                               const TexelLayout& layout) {
    if constexpr (HasTexels<Term>) {
      if (!layout.fits) return;
      if ((frame.views[0].width | frame.views[1].width) % kInPiece == 0) {
        copy<kInPiece>(term, frame, layout);
      } else {
        copy<1>(term, frame, layout);
      }
      __pipeline_commit();
    }
  }
  /// Waits for this thread's copies; a barrier must follow.
  __device__ __forceinline__ static void wait() {
    if constexpr (HasTexels<Term>) __pipeline_wait_prior(0);
  }
  template <int kView>
  __device__ __forceinline__ Texel at(int x, int y) const {
    return reinterpret_cast<const Texel*>(shared_floats())[first_[kView] + y * pitch_ + x];
  }

 private:
  static constexpr int kSize = static_cast<int>(sizeof(Texel));
  static constexpr int kPiece = 16;  // bytes per copy of a thread
  static constexpr int kInPiece = kPiece / kSize;

  /// Columns of a box and one on either side, within the tile, rounded to whole pieces.
  struct Columns {
    int first, count;
    __device__ __forceinline__ Columns(const Box& box, int width)
        : first(max(box.x0 - 1, 0) / kInPiece * kInPiece),
          count(min((box.x1 + kInPiece) / kInPiece * kInPiece, width) - first) {}
  };

  template <int kTexels>
  __device__ __forceinline__ static void copy(const Term& term, const FrameLayout& frame,
                                              const TexelLayout& layout) {
    static_assert(kSize == 4 || kSize == 8 || kSize == 16, "a Texel has 4, 8 or 16 bytes");
    const int in_left = layout.in_left, pitch = layout.pitch, rows = layout.rows;
    const int widths[2] = {frame.views[0].width, frame.views[1].width};
    const Texel* const left = term.texels(0) + (layout.y0 * widths[0] + layout.columns[0]);
    const Texel* const right =
        term.texels(1) + (layout.y0 * widths[1] + layout.columns[1] - in_left);
    auto* out = reinterpret_cast<Texel*>(shared_floats()) + layout.begin;
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    const int warps = static_cast<int>(blockDim.x) / kWarp;
#pragma unroll 1  // keeps the code short
    for (int row = static_cast<int>(threadIdx.x) / kWarp; row < rows; row += warps) {
      const Texel* const in_left_row = left + row * widths[0];
      const Texel* const in_right_row = right + row * widths[1];
#pragma unroll 1  // keeps the code short
      for (int x = kTexels * lane; x < pitch; x += kTexels * kWarp) {
        __pipeline_memcpy_async(out + row * pitch + x,
                                (x < in_left ? in_left_row : in_right_row) + x, kTexels * kSize);
      }
    }
  }

  int first_[2];
  int pitch_;
};

/// Adds a pixel to a Term's sums, with texels if the Term has them. Returns what pixel() returns.
template <int kReference, class Term, class Pixel, class Texels>
__device__ __forceinline__ auto add_pixel(const Term& term, const Pixel& p, const Texels& texels,
                                          float (&sums)[Term::kSums]) {
  if constexpr (HasTexels<Term>) {
    return term.template pixel<kReference>(p, texels, sums);
  } else {
    return term.template pixel<kReference>(p, sums);
  }
}

}  // namespace hypotrack::cuda
