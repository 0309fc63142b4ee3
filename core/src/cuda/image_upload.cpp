#include "cuda/image_upload.hpp"

#include <cstring>

namespace hypotrack::cuda {
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
  if (page_locked(rows.ptr()) && page_locked(rows.ptr(rows.rows - 1) + width - 1)) {
    flush(stream);
    check(cudaMemcpy2DAsync(device_.data() + at, width, rows.ptr(), rows.step, width, height,
                            cudaMemcpyHostToDevice, native(stream)),
          "uploading an image");
    end_ = first_ = (at + width * height + kAlignment - 1) / kAlignment * kAlignment;
    return device_.data() + at;
  }
  unsigned char* to = staging_.data() + at;
  for (int y = 0; y < rows.rows; ++y, to += width) std::memcpy(to, rows.ptr(y), width);
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

}  // namespace hypotrack::cuda
