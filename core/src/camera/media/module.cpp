#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "camera/media/library.hpp"

namespace hypotrack::internal {
namespace {

class CapturedFile final : public VideoFile {
 public:
  explicit CapturedFile(const std::string& file) : capture_(file) {
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  }
  bool is_open() const { return capture_.isOpened(); }
  bool grab() override { return capture_.grab(); }
  bool retrieve(cv::Mat& frame) override { return capture_.retrieve(frame); }

 private:
  cv::VideoCapture capture_;
};

cv::Mat read(const std::string& file, int flags) { return cv::imread(file, flags); }

bool write(const std::string& file, const cv::Mat& image, const std::vector<int>& parameters) {
  return cv::imwrite(file, image, parameters);
}

cv::Mat decode(const cv::Mat& bytes, int flags) { return cv::imdecode(bytes, flags); }

std::vector<unsigned char> encode(const std::string& extension, const cv::Mat& image,
                                  const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(extension, image, bytes, parameters)) bytes.clear();
  return bytes;
}

std::unique_ptr<VideoFile> open(const std::string& file) {
  auto video = std::make_unique<CapturedFile>(file);
  if (!video->is_open()) return nullptr;
  return video;
}

}  // namespace
}  // namespace hypotrack::internal

extern "C" __attribute__((visibility("default"))) const hypotrack::MediaLibrary&
hypotrack_media_library() {
  static constexpr hypotrack::MediaLibrary kLibrary = {
      hypotrack::read, hypotrack::write, hypotrack::decode, hypotrack::encode, hypotrack::open};
  return kLibrary;
}
