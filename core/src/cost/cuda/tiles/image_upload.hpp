#pragma once

#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Uploads parts of one view's images, one after the other, into one block of device memory.
class ImageUpload {
 public:
  /// Allocates `bytes` on host and device. Earlier work must have been waited for.
  void begin(std::size_t bytes);

  /// Adds a part of an image and returns its device address, row by row without gaps. Page-locked
  /// images are copied directly, others through page-locked memory.
  const unsigned char* add(const cv::Mat& image, const cv::Rect& part, Stream stream);

  /// Enqueues the remaining copies of add().
  void finish(Stream stream);

 private:
  void flush(Stream stream);

  DeviceBuffer<unsigned char> device_;
  PinnedBuffer<unsigned char> staging_;
  std::size_t end_ = 0;    // end of the added parts
  std::size_t first_ = 0;  // start of the parts not yet copied
};

}  // namespace internal
}  // namespace hypotrack::cuda
