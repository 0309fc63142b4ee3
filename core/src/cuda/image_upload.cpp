#include "cuda/image_upload.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <cstring>

#include "cuda/pooled_mat_allocator.hpp"

namespace hypotrack::cuda {
namespace {

constexpr std::size_t kAlignment = 256;

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

/// The device's address of page-locked memory; null for any other.
const unsigned char* on_device(const unsigned char* address) {
  cudaPointerAttributes attributes{};
  if (cudaPointerGetAttributes(&attributes, address) != cudaSuccess) {
    (void)cudaGetLastError();
    return nullptr;
  }
  if (attributes.type != cudaMemoryTypeHost) return nullptr;
  return static_cast<const unsigned char*>(attributes.devicePointer);
}

/// The device's address of rows that lie in page-locked memory, as those of images from the pool
/// are known to; null for any other.
const unsigned char* where_page_locked(const cv::Mat& rows, std::size_t width) {
  if (rows.u && dynamic_cast<const PooledMatAllocator*>(rows.u->currAllocator)) return rows.ptr();
  return on_device(rows.ptr(rows.rows - 1) + width - 1) ? on_device(rows.ptr()) : nullptr;
}

/// Rows without gaps. One core reads images that it has not in its cache at a fraction of what the
/// memory gives.
void copy_rows(const cv::Mat& rows, std::size_t width, unsigned char* to) {
  constexpr int kPieces = 4;
  const int grain = (rows.rows + kPieces - 1) / kPieces;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, rows.rows, grain),
      [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
          std::memcpy(to + static_cast<std::size_t>(y) * width, rows.ptr(y), width);
        }
      },
      tbb::simple_partitioner());
}

}  // namespace

void ImageUpload::begin(std::size_t bytes) {
  bytes += kMostFetched * kAlignment;
  device_.reserve(bytes);
  staging_.reserve(bytes);
  end_ = staged_ = 0;
  job_ = {};
}

ImageUpload::Placed ImageUpload::add(const cv::Mat& image, const cv::Rect& part) {
  const cv::Mat rows = image(part);
  const std::size_t width = rows.elemSize() * static_cast<std::size_t>(rows.cols);
  FetchedRows& fetched = job_.rows[job_.count++];
  fetched.from = where_page_locked(rows, width);
  fetched.step = static_cast<std::int64_t>(rows.step);
  if (!fetched.from) {
    copy_rows(rows, width, staging_.data() + staged_);
    fetched.from = staging_.data() + staged_;
    fetched.step = static_cast<std::int64_t>(width);
    staged_ = aligned(staged_ + width * static_cast<std::size_t>(rows.rows));
  }
  fetched.width = static_cast<std::int32_t>(width);
  fetched.count = rows.rows;
  fetched.pitch = (fetched.width + 3) / 4 * 4;
  fetched.to = device_.data() + end_;
  end_ =
      aligned(end_ + static_cast<std::size_t>(fetched.pitch) * static_cast<std::size_t>(rows.rows));
  return {fetched.to, fetched.pitch};
}

void ImageUpload::enqueue(Stream stream) {
  if (job_.count > 0) enqueue_fetch(job_, stream);
}

}  // namespace hypotrack::cuda
