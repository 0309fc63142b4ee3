#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/gpu/device_objective.hpp"

/// Normal equations of pixel residuals in GPU memory. The method is that of
/// cost/linearize/pixel_rows.hpp.
namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Side of the squares of columns whose products a warp sums.
inline constexpr int kRowSide = 32;
inline constexpr int kRowSquare = kRowSide * kRowSide;
/// Returns the number of squares that cover D + 1 columns; only one of two symmetric squares is.
inline int row_squares(int columns) {
  const int sides = (columns + kRowSide) / kRowSide;
  return sides * (sides + 1) / 2;
}
/// Returns the number of sums: the squares on and above the diagonal, in rows; each square column
/// by column.
inline int row_numbers(int columns) { return kRowSquare * row_squares(columns); }
/// Returns the number of blocks of threads that share the pixels of a point's views.
std::int64_t row_blocks(std::int64_t pixels, std::int64_t points);
/// Returns the number of floats of PixelRowsJob::records per point.
std::int64_t record_floats(const SceneLayout& scene, int sets, int columns);

/// Input and output of enqueue_pixel_rows(), all in device memory.
struct PixelRowsJob {
  const FrameLayout* frame;
  int view_count;
  bool pair;                  ///< as in the frame
  int pixels;                 ///< of all views, one after the other
  int terms;                  ///< number of terms over pixels
  int columns;                ///< D
  int points;                 ///< points of linearisation; each has all of the following
  const double* states;       ///< D + 1: the drawn one, then one per column
  const float* per_step;      ///< D: 1 / the change of the column's parameter, 0 for none
  const float* blurs;         ///< 1: pixels over which a passing silhouette changes a residual
  const float* depth;         ///< `pixels`, of the drawn state
  const PixelSlope* slopes;   ///< terms x pixels
  float* records;             ///< scratch: record_floats()
  std::uint32_t* owners;      ///< scratch: the triangle that is drawn at each pixel
  float* parts;               ///< scratch: row_numbers(D) x row_blocks()
  double* sums;               ///< row_numbers(D): products of the columns, the last one is r
  const std::int32_t* rests;  ///< 1: not 0 if its sums stay as they are; null: none does
};

/// Enqueues the posing of all states into `records`, before enqueue_owners(). It reads only the
/// states.
void enqueue_posing(const SceneLayout& scene, const DeviceLimits& limits, const PixelRowsJob& job,
                    Stream stream);
/// Enqueues the search for each pixel's triangle, before enqueue_pixel_rows(). It reads the records
/// and the depth.
void enqueue_owners(const SceneLayout& scene, const DeviceLimits& limits, const PixelRowsJob& job,
                    Stream stream);
/// Enqueues the sums, which are the same in every run.
void enqueue_pixel_rows(const SceneLayout& scene, const DeviceLimits& limits,
                        const PixelRowsJob& job, Stream stream);

}  // namespace internal
}  // namespace hypotrack::cuda
