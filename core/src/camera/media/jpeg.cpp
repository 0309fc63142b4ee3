#include <turbojpeg.h>

#include <memory>
#include <type_traits>

#include "camera/media/library.hpp"

namespace hypotrack::internal {
namespace {

struct Destroy {
  void operator()(tjhandle decoder) const { tjDestroy(decoder); }
};
using TurboJpeg = std::unique_ptr<std::remove_pointer_t<tjhandle>, Destroy>;

}  // namespace

cv::Mat decode_jpeg(const cv::Mat& bytes) {
  const auto* const data = bytes.ptr<unsigned char>();
  const auto size = static_cast<unsigned long>(bytes.total());
  if (size < 3 || data[0] != 0xFF || data[1] != 0xD8 || data[2] != 0xFF) return {};
  const TurboJpeg decoder(tjInitDecompress());
  int width = 0, height = 0, sampling = 0, colors = 0;
  if (!decoder ||
      tjDecompressHeader3(decoder.get(), data, size, &width, &height, &sampling, &colors) != 0)
    return {};
  if (colors != TJCS_YCbCr && colors != TJCS_RGB) return {};
  cv::Mat3b image(height, width);
  const int row = static_cast<int>(image.step);
  if (tjDecompress2(decoder.get(), data, size, image.data, width, row, height, TJPF_BGR, 0) != 0)
    return {};
  return image;
}

}  // namespace hypotrack::internal
