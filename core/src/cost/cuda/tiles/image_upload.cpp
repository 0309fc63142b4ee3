#include "cost/cuda/tiles/image_upload.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <cstring>

#include "cost/cuda/memory/pooled_mat_allocator.hpp"

namespace hypotrack::cuda::internal {
namespace {

constexpr std::size_t kAlignment = 256;

bool page_locked(const void* address) {
  cudaPointerAttributes attributes{};
  if (cudaPointerGetAttributes(&attributes, address) != cudaSuccess) {
    (void)cudaGetLastError();
    return false;
  }
  return attributes.type == cudaMemoryTypeHost;
}

/// Returns true if rows of `width` bytes are page-locked. Images from the pool are; asking the
/// driver takes longer.
bool page_locked(const cv::Mat& rows, std::size_t width) {
  if (rows.u && dynamic_cast<const PooledMatAllocator*>(rows.u->currAllocator)) return true;
  return page_locked(rows.ptr()) && page_locked(rows.ptr(rows.rows - 1) + width - 1);
}

/// Copies rows without gaps, in parallel: one core reads uncached images at a fraction of the
/// memory's bandwidth.
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
  bytes += 4 * kAlignment;
  device_.reserve(bytes);
  staging_.reserve(bytes);
  end_ = first_ = 0;
}

const unsigned char* ImageUpload::add(const cv::Mat& image, const cv::Rect& part, Stream stream) {
  const cv::Mat rows = image(part);
  const std::size_t width = rows.elemSize() * static_cast<std::size_t>(rows.cols);
  const auto height = static_cast<std::size_t>(rows.rows);
  const std::size_t at = end_;
  if (page_locked(rows, width)) {
    flush(stream);
    check(cudaMemcpy2DAsync(device_.data() + at, width, rows.ptr(), rows.step, width, height,
                            cudaMemcpyHostToDevice, native(stream)),
          "uploading an image");
    end_ = first_ = (at + width * height + kAlignment - 1) / kAlignment * kAlignment;
    return device_.data() + at;
  }
  copy_rows(rows, width, staging_.data() + at);
  end_ = (at + width * height + kAlignment - 1) / kAlignment * kAlignment;
  return device_.data() + at;
}

void ImageUpload::flush(Stream stream) {
  if (end_ == first_) return;
  check(cudaMemcpyAsync(device_.data() + first_, staging_.data() + first_, end_ - first_,
                        cudaMemcpyHostToDevice, native(stream)),
        "uploading an image");
  first_ = end_;
}

void ImageUpload::finish(Stream stream) { flush(stream); }

}  // namespace hypotrack::cuda::internal
