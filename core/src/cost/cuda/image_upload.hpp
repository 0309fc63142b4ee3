#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// Takes parts of one view's images to the device, one after the other in one piece of memory.
class ImageUpload {
 public:
  /// Room for `bytes` on either side. What was enqueued before must have been waited for.
  void begin(std::size_t bytes);

  /// Where the part will lie, row by row without gaps. An image in page-locked memory is copied
  /// from where it is, any other into page-locked memory first.
  const unsigned char* add(const cv::Mat& image, const cv::Rect& part, Stream stream);

  /// Enqueues the copy of what begin() and add() have gathered.
  void finish(Stream stream);

 private:
  void flush(Stream stream);

  DeviceBuffer<unsigned char> device_;
  PinnedBuffer<unsigned char> staging_;
  std::size_t end_ = 0;    // of what was added
  std::size_t first_ = 0;  // of what was gathered and not yet copied
};

}  // namespace hypotrack::cuda
