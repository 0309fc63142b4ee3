#pragma once

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/block_plan.hpp"
#include "hypotrack/cuda/cull.cuh"

/// Bands of rows: how the blocks of a hypothesis share its pixels and join their sums.
namespace hypotrack::cuda {

/// The shares of a hypothesis' work that lie above a band's first row and above the row behind its
/// last one.
struct BandShares {
  float before, after;
};

/// The share of the rows above `band` of `bands`, all of which have about the same share of the
/// work (FrameLayout::work_ends).
__device__ __forceinline__ float share_before(const float* work_ends, int band, int bands) {
  const int at = small_quotient(band * kMostBands, bands), rest = band * kMostBands - at * bands;
  const float before = work_ends[at], after = work_ends[min(at + 1, kMostBands)];
  return fmaf(exact_float(rest) * reciprocal(exact_float(bands)), after - before, before);
}

/// Those of bands with as many rows each.
__device__ __forceinline__ BandShares even_shares(int band, int bands) {
  const float one = reciprocal(exact_float(bands));
  return {exact_float(band) * one, exact_float(band + 1) * one};
}

/// The first of `rows` below a share of them. Bands that meet at a share meet at a row.
__device__ __forceinline__ int row_at(const Span& rows, float share) {
  return rows.first + round_nearest(exact_float(rows.last - rows.first) * share);
}

/// A slot in device memory through which one block hands a number to another. While there is none
/// in it all its bits are set, which no arithmetic makes.
inline constexpr std::uint64_t kEmptySlot = ~std::uint64_t{0};
__device__ __forceinline__ void fill_slot(double* slot, double value) {
  store_relaxed(slot, value);
}
/// The bits of the number, or kEmptySlot.
__device__ __forceinline__ std::uint64_t look_into_slot(const double* slot) {
  return load_relaxed_bits(slot);
}
__device__ __forceinline__ void clear_slot(double* slot) { store_relaxed_bits(slot, kEmptySlot); }
/// Waits for the number and leaves the slot empty.
__device__ __forceinline__ double empty_slot(double* slot) {
  std::uint64_t bits;
  do {
    bits = look_into_slot(slot);
  } while (bits == kEmptySlot);
  clear_slot(slot);
  return __longlong_as_double(static_cast<long long>(bits));
}

/// With one warp, which has its block's sums in all lanes: the first block of a hypothesis adds up
/// all bands, in their order, and returns true. The others hand theirs over in slots, kSums per
/// band, that say whether there is something in them, so that nothing has to be fenced. Those who
/// wait take up at most half of the multiprocessors (plan_blocks), so that the others always get
/// their turn. `room` is shared memory for kSums * bands numbers.
template <int kSums>
__device__ __forceinline__ bool join_bands(double* slots, int band, int bands, double* room,
                                           double (&total)[kSums]) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  if (band > 0) {
    for (int i = 0; i < kSums; ++i) {
      if (lane == i % kWarp) fill_slot(slots + band * kSums + i, total[i]);
    }
    return false;
  }
  __syncwarp();  // the lanes have read what was in the room before
  for (int i = kSums + lane; i < bands * kSums; i += kWarp) room[i] = empty_slot(slots + i);
  __syncwarp();
#pragma unroll 1
  for (int b = 1; b < bands; ++b) {
    for (int i = 0; i < kSums; ++i) total[i] += room[b * kSums + i];
  }
  return true;
}

}  // namespace hypotrack::cuda
