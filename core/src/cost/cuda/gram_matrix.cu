#include "cost/cuda/gram_matrix.hpp"

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {
namespace {

constexpr int kThreads = 256;
constexpr int kWarps = kThreads / kWarp;
constexpr int kSquaresPerBlock = 32;

__device__ double warp_sum(double x) {
  for (int step = kWarp / 2; step > 0; step /= 2) x += __shfl_xor_sync(kWholeWarp, x, step);
  return x;
}

/// Four neighbouring columns, one of which may be r itself, and others beyond it nothing.
struct Columns {
  const float* first;
  std::int64_t pitch;
  int differences, columns;  ///< of the four

  __device__ Columns(const GramJob& job, int side)
      : first(job.beside + job.rows * (kGramSide * side)),
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

/// A warp adds up one square of the matrix over the block's rows.
__device__ void add_square(const GramJob& job, int square, std::int64_t begin, std::int64_t end) {
  int a = 0, b = square;
  for (int sides = (job.dimension + kGramSide) / kGramSide; b >= sides - a; ++a) b -= sides - a;
  b += a;
  const Columns left(job, a), right(job, b);
  float sums[kGramSide][kGramSide] = {};
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (std::int64_t row = begin + lane; row < end; row += kWarp) {
    const float here = job.here[row];
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
      job.parts[(std::int64_t{square} * kGramSquare + k) * gridDim.x + blockIdx.x] = sum;
    }
  }
}

/// A column of blocks for every few squares, a row for every few rows.
__global__ void __launch_bounds__(kThreads)
    add_parts(const __grid_constant__ GramJob job, int squares) {
  const std::int64_t begin = kGramRows * blockIdx.x;
  const std::int64_t end = min(begin + kGramRows, job.rows);
  const int first = static_cast<int>(blockIdx.y) * kSquaresPerBlock;
  const int last = min(first + kSquaresPerBlock, squares);
  for (int square = first + static_cast<int>(threadIdx.x) / kWarp; square < last;
       square += kWarps) {
    add_square(job, square, begin, end);
  }
}

/// A warp per number.
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
  const int squares = gram_squares(job.dimension), numbers = gram_numbers(job.dimension);
  const std::int64_t blocks = gram_blocks(job.rows);
  if (blocks > 0) {
    launch(&add_parts,
           dim3(static_cast<unsigned>(blocks),
                static_cast<unsigned>((squares + kSquaresPerBlock - 1) / kSquaresPerBlock)),
           dim3(kThreads), 0, stream, false, job, squares);
  }
  launch(&join_parts, dim3(static_cast<unsigned>((numbers + kWarps - 1) / kWarps)), dim3(kThreads),
         0, stream, false, job, numbers, blocks);
}

}  // namespace hypotrack::cuda
