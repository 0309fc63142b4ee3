#pragma once

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/block_plan.hpp"
#include "hypotrack/cuda/cull.cuh"

/// Bands of rows: how the blocks of a hypothesis share its pixels and join their sums.
namespace hypotrack::cuda {

/// With one warp: the rows of `rows.first` <= y < `rows.last` that are of `band`, in all lanes.
/// Every row is of one band, and all bands have about the same share of the vertices and of the
/// rows. `bins` are kHistogramBins counts of vertices, each of 2^shift rows.
__device__ __forceinline__ Span find_band(const int2* bins, int shift, int vertex_count, Span rows,
                                          int band, int bands) {
  static_assert(kHistogramBins == 2 * kWarp, "a lane looks at two bins");
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int2 vertices = bins[lane];
  // A row weighs as much as its vertices and half of an average row.
  const float height = exact_float(max(rows.last - rows.first, 1));
  const int of_a_row = 1 + round_down(exact_float(vertex_count) * reciprocal(height));
  const auto end_of_bin = [&](int bin) {
    return min(max((bin + 1) << shift, rows.first), rows.last);
  };
  const int begin = end_of_bin(2 * lane - 1), end0 = end_of_bin(2 * lane);
  const int end1 = end_of_bin(2 * lane + 1);
  const int first = 2 * vertices.x + of_a_row * (end0 - begin);
  const int second = 2 * vertices.y + of_a_row * (end1 - end0);
  const int at1 = warp_scan(first + second), at0 = at1 - second;
  // A band ends with the last bin that ends within its share of the weight, far below 2^31.
  const int total = __shfl_sync(kWholeWarp, at1, kWarp - 1);
  const auto end_of_bands = [&](int count) {
    const int bound = total * count;
    const unsigned within0 = __ballot_sync(kWholeWarp, at0 * bands <= bound);
    const unsigned within1 = __ballot_sync(kWholeWarp, at1 * bands <= bound);
    return end_of_bin(__popc(within0) + __popc(within1) - 1);
  };
  return {band == 0 ? rows.first : end_of_bands(band),
          band + 1 == bands ? rows.last : end_of_bands(band + 1)};
}

/// A slot in device memory through which one block hands a number to another. While there is none
/// in it all its bits are set, which no arithmetic makes.
inline constexpr std::uint64_t kEmptySlot = ~std::uint64_t{0};
__device__ __forceinline__ void fill_slot(double* slot, double value) {
  asm volatile("st.relaxed.gpu.global.f64 [%0], %1;" ::"l"(slot), "d"(value) : "memory");
}
/// Waits for the number and leaves the slot empty.
__device__ __forceinline__ double empty_slot(double* slot) {
  std::uint64_t bits;
  do {
    asm volatile("ld.relaxed.gpu.global.u64 %0, [%1];" : "=l"(bits) : "l"(slot) : "memory");
  } while (bits == kEmptySlot);
  asm volatile("st.relaxed.gpu.global.u64 [%0], %1;" ::"l"(slot), "l"(kEmptySlot) : "memory");
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
