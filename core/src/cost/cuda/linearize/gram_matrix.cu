#include "cost/cuda/linearize/gram_matrix.hpp"

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda::internal {
namespace {

constexpr int kThreads = 256;
constexpr int kWarps = kThreads / kWarp;
constexpr int kSquaresPerBlock = kWarps;

__device__ double warp_sum(double x) {
  for (int step = kWarp / 2; step > 0; step /= 2) x += __shfl_xor_sync(kWholeWarp, x, step);
  return x;
}

/// Four neighbouring columns: differences, r itself as the last, and zeros after it.
struct Columns {
  const float* first;
  std::int64_t pitch;
  int differences, columns;  ///< how many of the four

  __device__ Columns(const GramJob& job, int side)
      : first(job.beside + job.stride * blockIdx.z + job.rows * (kGramSide * side)),
        pitch(job.rows),
        differences(min(job.dimension - kGramSide * side, kGramSide)),
        columns(min(job.dimension + 1 - kGramSide * side, kGramSide)) {}

  __device__ __forceinline__ void load(std::int64_t row, float here,
                                       float (&values)[kGramSide]) const {
#pragma unroll
    for (int i = 0; i < kGramSide; ++i) {
      values[i] = i < differences ? first[i * pitch + row] - here : i < columns ? here : 0.0f;
    }
  }
};

/// Sums one square of the matrix over the block's rows, with one warp.
__device__ void add_square(const GramJob& job, int squares, int square, std::int64_t begin,
                           std::int64_t end) {
  int a = 0, b = square;
  for (int sides = (job.dimension + kGramSide) / kGramSide; b >= sides - a; ++a) b -= sides - a;
  b += a;
  const Columns left(job, a), right(job, b);
  float sums[kGramSide][kGramSide] = {};
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (std::int64_t row = begin + lane; row < end; row += kWarp) {
    const float here = job.here[job.stride * blockIdx.z + row];
    float x[kGramSide], y[kGramSide];
    left.load(row, here, x);
    right.load(row, here, y);
#pragma unroll
    for (int i = 0; i < kGramSide; ++i) {
#pragma unroll
      for (int j = 0; j < kGramSide; ++j) sums[i][j] = fmaf(x[i], y[j], sums[i][j]);
    }
  }
#pragma unroll
  for (int k = 0; k < kGramSquare; ++k) {
    const float sum = cuda::warp_sum(sums[k / kGramSide][k % kGramSide]);
    if (lane == 0) {
      const std::int64_t place = std::int64_t{blockIdx.z} * squares + square;
      job.parts[(place * kGramSquare + k) * gridDim.x + blockIdx.x] = sum;
    }
  }
}

/// Sums the parts: blocks in z for matrices, in y for groups of squares, in x for groups of rows.
__global__ void __launch_bounds__(kThreads)
    add_parts(const __grid_constant__ GramJob job, int squares) {
  const std::int64_t begin = kGramRows * blockIdx.x;
  const std::int64_t end = min(begin + kGramRows, job.rows);
  const int first = static_cast<int>(blockIdx.y) * kSquaresPerBlock;
  const int last = min(first + kSquaresPerBlock, squares);
  for (int square = first + static_cast<int>(threadIdx.x) / kWarp; square < last;
       square += kWarps) {
    add_square(job, squares, square, begin, end);
  }
}

/// Adds up the parts of each number, one warp per number.
__global__ void __launch_bounds__(kThreads)
    join_parts(const __grid_constant__ GramJob job, int numbers, std::int64_t parts) {
  const int number = static_cast<int>(blockIdx.x) * kWarps + static_cast<int>(threadIdx.x) / kWarp;
  if (number >= numbers) return;
  const float* own = job.parts + number * parts;
  double sum = 0;
  for (std::int64_t i = threadIdx.x % kWarp; i < parts; i += kWarp) sum += own[i];
  sum = warp_sum(sum);
  if (threadIdx.x % kWarp == 0) job.sums[number] = sum;
}

}  // namespace

void enqueue_gram(const GramJob& job, Stream stream) {
  const int squares = gram_squares(job.dimension);
  const int numbers = job.count * gram_numbers(job.dimension);
  const std::int64_t blocks = gram_blocks(job.rows);
  if (blocks > 0) {
    launch(&add_parts,
           dim3(static_cast<unsigned>(blocks),
                static_cast<unsigned>((squares + kSquaresPerBlock - 1) / kSquaresPerBlock),
                static_cast<unsigned>(job.count)),
           dim3(kThreads), 0, stream, false, job, squares);
  }
  launch(&join_parts, dim3(static_cast<unsigned>((numbers + kWarps - 1) / kWarps)), dim3(kThreads),
         0, stream, false, job, numbers, blocks);
}

}  // namespace hypotrack::cuda::internal
