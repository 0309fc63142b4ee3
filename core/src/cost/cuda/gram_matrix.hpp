#pragma once

#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"

/// Normal equations in GPU memory: the matrix of inner products of D + 1 columns, those of
/// residuals' differences and the residuals themselves.
namespace hypotrack::cuda {

/// Columns are taken together in squares of four by four; of symmetric ones, one is computed.
inline constexpr int kGramSide = 4;
inline constexpr int kGramSquare = kGramSide * kGramSide;
/// Rows that one block of threads adds up.
inline constexpr std::int64_t kGramRows = 256;

inline int gram_sides(int dimension) { return (dimension + kGramSide) / kGramSide; }  // of D + 1
inline int gram_squares(int dimension) {
  const int sides = gram_sides(dimension);
  return sides * (sides + 1) / 2;
}
/// Numbers of a matrix: squares row by row of the matrix above and on its diagonal, each row by
/// row. Those beyond D + 1 are 0.
inline int gram_numbers(int dimension) { return kGramSquare * gram_squares(dimension); }
inline std::int64_t gram_blocks(std::int64_t rows) { return (rows + kGramRows - 1) / kGramRows; }

/// Everything is in device memory.
struct GramJob {
  const float* here;    ///< r: `rows` residuals
  const float* beside;  ///< D times as many, `rows` from one to the next
  std::int64_t rows;
  std::int32_t dimension;  ///< D
  float* parts;            ///< gram_numbers(D) x gram_blocks(rows)
  double* sums;            ///< gram_numbers(D): columns are r_i - r, the last one is r
};

/// Enqueues the sums; the same in every run.
HYPOTRACK_API void enqueue_gram(const GramJob& job, Stream stream);

}  // namespace hypotrack::cuda
