#include <opencv2/imgcodecs.hpp>

#include "camera/media/library.hpp"

namespace hypotrack::internal {
namespace {

cv::Mat read(const std::string& file, int flags) { return cv::imread(file, flags); }

bool write(const std::string& file, const cv::Mat& image, const std::vector<int>& parameters) {
  return cv::imwrite(file, image, parameters);
}

cv::Mat decode(const cv::Mat& bytes, int flags) {
  constexpr int kAsStored = cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION;
  if (flags == cv::IMREAD_UNCHANGED || flags == kAsStored)
    if (cv::Mat image = decode_jpeg(bytes); !image.empty()) return image;
  return cv::imdecode(bytes, flags);
}

std::vector<unsigned char> encode(const std::string& extension, const cv::Mat& image,
                                  const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(extension, image, bytes, parameters)) bytes.clear();
  return bytes;
}

}  // namespace
}  // namespace hypotrack::internal

extern "C" __attribute__((visibility("default"))) const hypotrack::MediaLibrary&
hypotrack_media_library() {
  static constexpr hypotrack::MediaLibrary kLibrary = {
      hypotrack::read,   hypotrack::write,     hypotrack::decode,
      hypotrack::encode, hypotrack::open_file, hypotrack::create_file};
  return kLibrary;
}
