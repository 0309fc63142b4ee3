#pragma once

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/cull.cuh"

/// Bands of rows: distributes a hypothesis' pixels over blocks and joins their sums.
namespace hypotrack::cuda {

/// The shares of a hypothesis' work above a band's first row and above the row after its last.
struct BandShares {
  float before, after;
};

/// Returns the share of the rows above `band` of `bands` bands with about equal work
/// (FrameLayout::work_ends).
__device__ __forceinline__ float share_before(const float* work_ends, int band, int bands) {
  const int at = small_quotient(band * kMostBands, bands), rest = band * kMostBands - at * bands;
  const float before = work_ends[at], after = work_ends[min(at + 1, kMostBands)];
  return fmaf(exact_float(rest) * reciprocal(exact_float(bands)), after - before, before);
}

/// Returns the shares of bands with equal numbers of rows.
__device__ __forceinline__ BandShares even_shares(int band, int bands) {
  const float one = reciprocal(exact_float(bands));
  return {exact_float(band) * one, exact_float(band + 1) * one};
}

/// Returns the first of `rows` below a share of them. Equal shares give equal rows, so that bands
/// meet.
__device__ __forceinline__ int row_at(const Span& rows, float share) {
  return rows.first + round_nearest(exact_float(rows.last - rows.first) * share);
}

/// A slot of BlockPlan::band_sums passes one number from one block to another.
__device__ __forceinline__ void fill_slot(double* slot, double value) {
  store_relaxed(slot, value);
}
/// Returns the bits of the slot's number, or kEmptySlot.
__device__ __forceinline__ std::uint64_t look_into_slot(const double* slot) {
  return load_relaxed_bits(slot);
}
__device__ __forceinline__ void clear_slot(double* slot) { store_relaxed_bits(slot, kEmptySlot); }
/// Waits for the slot's number, returns it and leaves the slot empty.
__device__ __forceinline__ double empty_slot(double* slot) {
  std::uint64_t bits;
  do {
    bits = look_into_slot(slot);
  } while (bits == kEmptySlot);
  clear_slot(slot);
  return __longlong_as_double(static_cast<long long>(bits));
}

/// Adds the sums of all bands of a hypothesis in the order of the bands; returns true in the first
/// block, which holds the totals. One warp per block calls it, with its block's sums in all lanes.
/// The other blocks pass kSums numbers each in slots. A slot shows whether it is full, so no fence
/// is needed. Waiting blocks take at most half of the multiprocessors (plan_blocks), so the others
/// always run. `room` is shared memory for kSums * bands numbers.
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
  __syncwarp();  // the lanes have read the previous content of `room`
  for (int i = kSums + lane; i < bands * kSums; i += kWarp) room[i] = empty_slot(slots + i);
  __syncwarp();
#pragma unroll 1
  for (int b = 1; b < bands; ++b) {
    for (int i = 0; i < kSums; ++i) total[i] += room[b * kSums + i];
  }
  return true;
}

}  // namespace hypotrack::cuda
