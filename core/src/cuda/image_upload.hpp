#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "cuda/fetch_kernel.hpp"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// Takes parts of a frame's images to the device, all with one kernel that reads page-locked host
/// memory: on the host that takes a fraction of what copies do that are enqueued one by one.
class ImageUpload {
 public:
  /// Room for at most kMostFetched images of `bytes` altogether, with 3 more for every row, on
  /// either side. What was enqueued before must have been waited for.
  void begin(std::size_t bytes);

  /// Where the part will lie, and the bytes from row to row there. An image in page-locked memory
  /// is read from where it is, any other copied into page-locked memory first.
  struct Placed {
    const unsigned char* first;
    std::int32_t pitch;
  };
  Placed add(const cv::Mat& image, const cv::Rect& part);

  /// Enqueues the kernel for what was added.
  void enqueue(Stream stream);

 private:
  DeviceBuffer<unsigned char> device_;
  PinnedBuffer<unsigned char> staging_;
  std::size_t end_ = 0;     // of what was added
  std::size_t staged_ = 0;  // bytes of staging_
  FetchJob job_{};
};

}  // namespace hypotrack::cuda
