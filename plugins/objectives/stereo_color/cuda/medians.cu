#include "cuda/feature_job.hpp"
#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/runtime.cuh"

// Radix selection of the median of many numbers. The histogram gives the bucket that holds it. Two
// passes over digits of ten bits find it among the bucket's keys.
namespace hypotrack::stereo_color {
namespace {

constexpr int kThreads = 1024;
constexpr int kWarps = kThreads / cuda::kWarp;
static_assert(kWarps == cuda::kWarp);
constexpr int kDigitBits = kBucketShift / 2;
constexpr int kDigits = 1 << kDigitBits;
constexpr int kCapacity = 8192;  // keys in shared memory; a larger bucket stays in global memory
constexpr int kBatch = 4;        // vectors of four keys that a thread has under way

/// The bin that contains the key of a rank.
struct Place {
  std::uint32_t bin, rank, count;  ///< rank among the bin's keys; count of its keys
};

struct Search {
  std::uint32_t bins[kBuckets];
  Key candidates[kCapacity];
  std::uint32_t candidate_count;
  std::uint32_t warp_totals[kWarps];
  Place place;
  int above;  ///< least key above the lower median
};

__device__ std::uint32_t lane() { return threadIdx.x % cuda::kWarp; }

__device__ std::uint32_t warp_inclusive_sum(std::uint32_t x) {
  for (unsigned step = 1; step < cuda::kWarp; step *= 2) {
    const std::uint32_t before = __shfl_up_sync(cuda::kWholeWarp, x, step);
    if (lane() >= step) x += before;
  }
  return x;
}

/// A thread's kEach bins, and the number of keys before them.
template <int kEach>
struct BinSums {
  std::uint32_t counts[kEach];
  std::uint32_t before;  ///< keys in the bins before
  std::uint32_t total;   ///< keys in all bins
};

template <int kEach>
__device__ BinSums<kEach> sum_bins(Search& s) {
  BinSums<kEach> out;
  std::uint32_t own = 0;
  for (int k = 0; k < kEach; ++k) {
    out.counts[k] = s.bins[threadIdx.x * kEach + k];
    own += out.counts[k];
  }
  const std::uint32_t in_warp = warp_inclusive_sum(own);
  const unsigned warp = threadIdx.x / cuda::kWarp;
  if (lane() == cuda::kWarp - 1) s.warp_totals[warp] = in_warp;
  __syncthreads();
  const std::uint32_t warps = warp_inclusive_sum(s.warp_totals[lane()]);
  const std::uint32_t up_to_warp = __shfl_sync(cuda::kWholeWarp, warps, warp);
  const std::uint32_t whole_warp = s.warp_totals[warp];
  out.before = up_to_warp - whole_warp + in_warp - own;
  out.total = __shfl_sync(cuda::kWholeWarp, warps, kWarps - 1);
  return out;
}

/// Finds the bin of a rank, which must be below sums.total.
template <int kEach>
__device__ Place find(Search& s, const BinSums<kEach>& sums, std::uint32_t rank) {
  std::uint32_t before = sums.before;
  for (int k = 0; k < kEach; ++k) {
    if (rank >= before && rank - before < sums.counts[k]) {
      s.place = {threadIdx.x * kEach + k, rank - before, sums.counts[k]};
    }
    before += sums.counts[k];
  }
  __syncthreads();
  return s.place;
}

/// Loads the bucket counts and clears them for the next frame.
__device__ void take_counts(Search& s, std::uint32_t* counts) {
  auto* from = reinterpret_cast<uint2*>(counts) + threadIdx.x;
  reinterpret_cast<uint2*>(s.bins)[threadIdx.x] = *from;
  *from = {0, 0};
  __syncthreads();
}

__device__ uint4 load_keys(const Key* keys, int at, int size) {
  if (at + 3 < size) return *reinterpret_cast<const uint4*>(keys + at);
  const auto one = [&](int i) { return i < size ? keys[i] : kNoKey; };
  return {one(at), one(at + 1), one(at + 2), one(at + 3)};
}

/// Copies the bucket's keys to shared memory, up to its capacity, and counts them. Returns the
/// least key of higher buckets that this thread has met.
__device__ Key collect(Search& s, const Key* keys, int size, std::uint32_t bucket) {
  Key above = kNoKey;
  for (int first = 0; first < size; first += kThreads * kBatch * 4) {
    Key own[kBatch * 4];
#pragma unroll
    for (int k = 0; k < kBatch; ++k) {
      const int at = first + 4 * (k * kThreads + static_cast<int>(threadIdx.x));
      const uint4 four = load_keys(keys, at, size);
      own[4 * k] = four.x;
      own[4 * k + 1] = four.y;
      own[4 * k + 2] = four.z;
      own[4 * k + 3] = four.w;
    }
    std::uint32_t matches = 0;
#pragma unroll
    for (const Key key : own) {
      matches += key >> kBucketShift == bucket ? 1 : 0;
      if (key >> kBucketShift > bucket) above = min(above, key);
    }
    const std::uint32_t in_warp = warp_inclusive_sum(matches);
    std::uint32_t at = 0;
    if (lane() == cuda::kWarp - 1 && in_warp > 0) at = atomicAdd(&s.candidate_count, in_warp);
    at = __shfl_sync(cuda::kWholeWarp, at, cuda::kWarp - 1) + in_warp - matches;
#pragma unroll
    for (const Key key : own) {
      if (key >> kBucketShift != bucket) continue;
      if (at < kCapacity) s.candidates[at] = key;
      ++at;
    }
  }
  __syncthreads();
  return above;
}

/// Counts the digit at `shift` of the keys whose upper bits are `prefix`.
__device__ void count_digits(Search& s, const Key* keys, int size, Key prefix, int shift) {
  s.bins[threadIdx.x] = 0;
  __syncthreads();
#pragma unroll 4
  for (int i = static_cast<int>(threadIdx.x); i < size; i += kThreads) {
    const Key key = keys[i];
    if (key >> (shift + kDigitBits) == prefix) atomicAdd(&s.bins[key >> shift & (kDigits - 1)], 1u);
  }
  __syncthreads();
}

/// Returns the least of the keys above `low` and of all threads' `above`.
__device__ Key next_above(Search& s, const Key* keys, int size, Key low, Key above) {
  for (int i = static_cast<int>(threadIdx.x); i < size; i += kThreads) {
    if (keys[i] > low) above = min(above, keys[i]);
  }
  const int least = cuda::warp_min(static_cast<int>(above));
  if (lane() == 0) atomicMin(&s.above, least);
  __syncthreads();
  return static_cast<Key>(s.above);
}

// Finds the medians, with one block per quantity and view.
__global__ void __launch_bounds__(kThreads) select_medians(const __grid_constant__ FeatureJob job) {
  __shared__ Search s;
  if (threadIdx.x == 0) {
    s.candidate_count = 0;
    s.above = static_cast<int>(kNoKey);
  }
  cuda::wait_for_previous();
  cuda::let_next_start();  // not earlier: the next kernel relies on the end of the first one
  const ViewJob& view = job.views[blockIdx.y];
  take_counts(s, view.counts + blockIdx.x * kBuckets);
  const auto buckets = sum_bins<kBuckets / kThreads>(s);
  const std::uint32_t count = buckets.total;
  if (count == 0) {
    if (threadIdx.x == 0) view.medians[blockIdx.x] = {0.0f, 0.0f};
    return;
  }
  Place place = find(s, buckets, (count - 1) / 2);
  Key low = place.bin;
  const Key* keys = view.keys[blockIdx.x];
  int size = view.tile.width * view.tile.height;
  const Key above = collect(s, keys, size, low);
  if (s.candidate_count <= kCapacity) {
    keys = s.candidates;
    size = static_cast<int>(s.candidate_count);
  }
  for (int shift = kDigitBits; shift >= 0; shift -= kDigitBits) {
    count_digits(s, keys, size, low, shift);
    place = find(s, sum_bins<kDigits / kThreads>(s), place.rank);
    low = low << kDigitBits | place.bin;
  }
  Key high = low;
  if (count % 2 == 0 && place.rank + 1 == place.count) {
    high = next_above(s, keys, size, low, above);
  }
  if (threadIdx.x == 0) {
    view.medians[blockIdx.x] = {__uint_as_float(low), __uint_as_float(high)};
  }
}

}  // namespace

void enqueue_medians(const FeatureJob& job, cuda::Stream stream, bool overlap) {
  cuda::launch(&select_medians, dim3(kQuantities, 2), dim3(kThreads), 0, stream, overlap, job);
}

}  // namespace hypotrack::stereo_color
