#pragma once

#include <cstdint>
#include <limits>

namespace hypotrack::cuda {

/// A particle's index and cost; the default stands for no particle.
struct Candidate {
  double cost = std::numeric_limits<double>::infinity();
  std::int32_t particle = std::numeric_limits<std::int32_t>::max();
};

/// Returns the candidate with the lower cost, on a tie with the lower index; never one with NaN.
__device__ __forceinline__ Candidate better(const Candidate& a, const Candidate& b) {
  const bool other = b.cost < a.cost || (b.cost == a.cost && b.particle < a.particle);
  return other ? b : a;
}

/// Returns the best candidate of a warp, in all its lanes.
__device__ __forceinline__ Candidate best_of_warp(Candidate mine) {
  constexpr unsigned kAll = 0xffffffffu;
#pragma unroll
  for (int offset = 16; offset > 0; offset /= 2) {
    const Candidate theirs{__shfl_xor_sync(kAll, mine.cost, offset),
                           __shfl_xor_sync(kAll, mine.particle, offset)};
    mine = better(mine, theirs);
  }
  return mine;
}

__device__ __forceinline__ Candidate best_of_strided(const double* costs, std::int32_t count,
                                                     std::int32_t first, std::int32_t stride) {
  Candidate best;
  for (std::int32_t i = first; i < count; i += stride) best = better(best, {__ldcg(costs + i), i});
  return best;
}

/// Returns the best of `count` costs in every thread of a block of kThreads; all threads call it.
template <int kThreads>
__device__ __forceinline__ Candidate best_of_costs(const double* costs, std::int32_t count) {
  constexpr int kWarp = 32;
  constexpr int kFew = 4 * kWarp;
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  // For few costs, each warp reads all of them, which is cheaper than a barrier.
  if (count <= kFew) return best_of_warp(best_of_strided(costs, count, lane, kWarp));

  __shared__ Candidate of_warp[kThreads / kWarp];
  const int thread = static_cast<int>(threadIdx.x);
  const Candidate mine = best_of_warp(best_of_strided(costs, count, thread, kThreads));
  if (lane == 0) of_warp[thread / kWarp] = mine;
  __syncthreads();
  return best_of_warp(lane < kThreads / kWarp ? of_warp[lane] : Candidate{});
}

}  // namespace hypotrack::cuda
