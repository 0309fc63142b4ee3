#pragma once

#include <cuda_pipeline_primitives.h>

#include <cstring>
#include <type_traits>

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/layout.hpp"

/// What a Term looks up per pixel of a pair's tiles: `texels.template at<view>(x, y)`.
namespace hypotrack::cuda {

template <class Term>
concept HasTexels = requires {
  typename Term::Texel;
};

/// For Terms without texels.
struct NoTexel {};
template <class Term>
struct TexelOf {
  using Type = NoTexel;
};
template <HasTexels Term>
struct TexelOf<Term> {
  using Type = typename Term::Texel;
};

/// Texels of whole tiles, in global memory.
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

/// Texels of a box per view and a column beside it, copied to the block's shared memory.
template <class Term>
class SharedTexels {
 public:
  using Texel = typename TexelOf<Term>::Type;
  bool fetched = false;

  /// Begins to copy, with the whole block, to shared_floats() from `begin` on, if there is room
  /// before `end`.
  __device__ __forceinline__ void fetch(const Term& term, const FrameLayout& frame, const Box& left,
                                        const Box& right, int begin, int end) {
    if constexpr (HasTexels<Term>) {
      const int widths[2] = {frame.views[0].width, frame.views[1].width};
      const Columns columns[2] = {Columns(left, widths[0]), Columns(right, widths[1])};
      const int pitch = columns[0].count + columns[1].count, rows = left.height();
      const int first = begin * 4 / kSize;
      fetched = first + pitch * rows <= end * 4 / kSize;
      if (!fetched) return;
      pitch_ = pitch;
      first_[0] = first - left.y0 * pitch - columns[0].first;
      first_[1] = first - left.y0 * pitch - columns[1].first + columns[0].count;
      if ((widths[0] | widths[1]) % kInPiece == 0) {
        copy<kInPiece>(term, widths, columns, left, first);
      } else {
        copy<1>(term, widths, columns, left, first);
      }
      __pipeline_commit();
    }
  }
  /// Until this thread's copies are there; a barrier must follow.
  __device__ __forceinline__ void wait() const {
    if constexpr (HasTexels<Term>) {
      if (fetched) __pipeline_wait_prior(0);
    }
  }
  template <int kView>
  __device__ __forceinline__ Texel at(int x, int y) const {
    return reinterpret_cast<const Texel*>(shared_floats())[first_[kView] + y * pitch_ + x];
  }

 private:
  static constexpr int kSize = static_cast<int>(sizeof(Texel));
  static constexpr int kPiece = 16;  // bytes that a thread copies at a time
  static constexpr int kInPiece = kPiece / kSize;

  /// Those of a box and one on either side, within the tile, rounded to whole pieces.
  struct Columns {
    int first, count;
    __device__ __forceinline__ Columns(const Box& box, int width)
        : first(max(box.x0 - 1, 0) / kInPiece * kInPiece),
          count(min((box.x1 + kInPiece) / kInPiece * kInPiece, width) - first) {}
  };

  /// A row of both views at a time lies behind the one before.
  template <int kTexels>
  __device__ __forceinline__ void copy(const Term& term, const int (&widths)[2],
                                       const Columns (&columns)[2], const Box& rows, int to) const {
    static_assert(kSize == 4 || kSize == 8 || kSize == 16, "a Texel has 4, 8 or 16 bytes");
    const int in_first = columns[0].count / kTexels, in_row = pitch_ / kTexels;
    const Texel* const left = term.texels(0) + columns[0].first;
    const Texel* const right = term.texels(1) + columns[1].first - kTexels * in_first;
    auto* out = reinterpret_cast<Texel*>(shared_floats()) + to;
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    const int warps = static_cast<int>(blockDim.x) / kWarp;
#pragma unroll 1  // the code is long enough
    for (int row = static_cast<int>(threadIdx.x) / kWarp; row < rows.height(); row += warps) {
      const Texel* const in_left = left + (rows.y0 + row) * widths[0];
      const Texel* const in_right = right + (rows.y0 + row) * widths[1];
#pragma unroll 1  // the code is long enough
      for (int place = lane; place < in_row; place += kWarp) {
        const Texel* from = place < in_first ? in_left : in_right;
        __pipeline_memcpy_async(out + kTexels * (row * in_row + place), from + kTexels * place,
                                kTexels * kSize);
      }
    }
  }

  int first_[2] = {0, 0};
  int pitch_ = 0;
};

/// A pixel's part of a Term's sums.
template <int kReference, class Term, class Pixel, class Texels>
__device__ __forceinline__ void add_pixel(const Term& term, const Pixel& p, const Texels& texels,
                                          float (&sums)[Term::kSums]) {
  if constexpr (HasTexels<Term>) {
    term.template pixel<kReference>(p, texels, sums);
  } else {
    term.template pixel<kReference>(p, sums);
  }
}

}  // namespace hypotrack::cuda
