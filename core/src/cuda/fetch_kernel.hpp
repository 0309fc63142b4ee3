#pragma once

#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"

namespace hypotrack::cuda {

/// Rows of bytes in page-locked host memory, and where they go on the device.
struct FetchedRows {
  const unsigned char* from;
  std::int64_t step;   ///< bytes from row to row
  std::int32_t width;  ///< bytes
  std::int32_t count;  ///< of rows
  unsigned char* to;   ///< aligned to 4 bytes
  std::int32_t pitch;  ///< bytes from row to row there, a multiple of 4, at least `width`
};
inline constexpr int kMostFetched = 3 * kMaxViews;  ///< colour, mask and depth of every view

struct FetchJob {
  FetchedRows rows[kMostFetched];
  std::int32_t count;
};

/// Enqueues the fetching of all rows.
void enqueue_fetch(const FetchJob& job, Stream stream);

}  // namespace hypotrack::cuda
