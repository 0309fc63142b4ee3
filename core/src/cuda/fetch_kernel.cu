#include "cuda/fetch_kernel.hpp"

#include <algorithm>

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {
namespace {

constexpr int kThreads = 256;
constexpr int kWarps = kThreads / kWarp;
constexpr int kInPiece = kWarp - 1;  // words that a warp writes: a word ends in the next one read

__host__ __device__ int words(const FetchedRows& rows) { return (rows.width + 3) / 4; }
__host__ __device__ int pieces_per_row(const FetchedRows& rows) {
  return (words(rows) + kInPiece - 1) / kInPiece;
}

// A warp per piece of a row, so that as much as can be is on its way from the host at once.
__global__ void __launch_bounds__(kThreads) fetch(const __grid_constant__ FetchJob job) {
  let_next_start();
  const FetchedRows& rows = job.rows[blockIdx.y];
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int in_row = pieces_per_row(rows);
  const int piece = static_cast<int>(blockIdx.x) * kWarps + static_cast<int>(threadIdx.x) / kWarp;
  const int y = piece / in_row;
  if (y >= rows.count) return;
  const unsigned char* begin = rows.from + y * rows.step;
  const auto shift = static_cast<int>(reinterpret_cast<std::uintptr_t>(begin) % 4);
  const auto* from = reinterpret_cast<const std::uint32_t*>(begin - shift);
  const int word = (piece - y * in_row) * kInPiece + lane;
  // The host writes there from frame to frame: nothing that a cache may have is to be trusted.
  const std::uint32_t low = 4 * word < shift + rows.width ? __ldcv(from + word) : 0;
  const std::uint32_t high = __shfl_down_sync(kWholeWarp, low, 1);
  if (lane == kInPiece || word >= words(rows)) return;
  auto* to = reinterpret_cast<std::uint32_t*>(rows.to + std::int64_t{y} * rows.pitch);
  to[word] = __funnelshift_r(low, high, static_cast<unsigned>(8 * shift));
}

}  // namespace

void enqueue_fetch(const FetchJob& job, Stream stream) {
  int pieces = 0;
  for (int i = 0; i < job.count; ++i) {
    pieces = std::max(pieces, pieces_per_row(job.rows[i]) * job.rows[i].count);
  }
  const dim3 blocks(static_cast<unsigned>((pieces + kWarps - 1) / kWarps),
                    static_cast<unsigned>(job.count));
  launch(fetch, blocks, kThreads, 0, stream, false, job);
}

}  // namespace hypotrack::cuda
