#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/gpu/device_objective.hpp"

/// Normal equations in GPU memory: the Gram matrix (inner products) of D + 1 columns, which are the
/// differences of residuals and the residuals themselves.
namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Side of the squares of columns that are computed together; only one of two symmetric squares is.
inline constexpr int kGramSide = 4;
inline constexpr int kGramSquare = kGramSide * kGramSide;
/// Rows that one block of threads sums.
inline constexpr std::int64_t kGramRows = 256;

inline int gram_sides(int dimension) { return (dimension + kGramSide) / kGramSide; }  // of D + 1
inline int gram_squares(int dimension) {
  const int sides = gram_sides(dimension);
  return sides * (sides + 1) / 2;
}
/// Returns the number of floats of a matrix: the squares on and above the diagonal, in rows, each
/// square row by row. Entries beyond D + 1 are 0.
inline int gram_numbers(int dimension) { return kGramSquare * gram_squares(dimension); }
inline std::int64_t gram_blocks(std::int64_t rows) { return (rows + kGramRows - 1) / kGramRows; }

/// Input and output of enqueue_gram(), all in device memory.
struct GramJob {
  const float* here;    ///< r: `rows` residuals
  const float* beside;  ///< D times `rows` residuals
  std::int64_t rows;
  std::int32_t dimension;   ///< D
  float* parts;             ///< count x gram_numbers(D) x gram_blocks(rows)
  double* sums;             ///< count x gram_numbers(D): columns are r_i - r, the last one is r
  std::int32_t count = 1;   ///< matrices
  std::int64_t stride = 0;  ///< floats between the residuals of two matrices
};

/// Enqueues the sums, which are the same in every run.
void enqueue_gram(const GramJob& job, Stream stream);

}  // namespace internal
}  // namespace hypotrack::cuda
