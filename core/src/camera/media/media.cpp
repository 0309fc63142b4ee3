#include "hypotrack/api/media.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "base/installation.hpp"
#include "camera/media/library.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

const MediaLibrary& load() {
  const std::filesystem::path file =
      detail::prefix_folder() / HYPOTRACK_LIBDIR / "hypotrack" / "libhypotrack_media.so";
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* function = module ? dlsym(module, kMediaLibrary) : nullptr;
  if (!function) {
    const char* why = dlerror();
    throw DeviceError(
        fmt::format("images and videos need {}, which cannot be loaded: {}; install OpenCV's "
                    "imgcodecs (libopencv-imgcodecs) and FFmpeg (libavformat, libswscale)",
                    file.string(), why ? why : "unknown reason"));
  }
  return reinterpret_cast<GetMediaLibrary>(function)();
}

const MediaLibrary& library() {
  static const MediaLibrary& loaded = load();
  return loaded;
}

}  // namespace

cv::Mat read_image(const std::string& file, int flags) { return library().read(file, flags); }

bool write_image(const std::string& file, const cv::Mat& image,
                 const std::vector<int>& parameters) {
  return library().write(file, image, parameters);
}

cv::Mat decode_image(const cv::Mat& bytes, int flags) { return library().decode(bytes, flags); }

std::vector<unsigned char> encode_image(const std::string& extension, const cv::Mat& image,
                                        const std::vector<int>& parameters) {
  return library().encode(extension, image, parameters);
}

std::span<const std::string_view> enum_names(ColorMatrix) {
  static constexpr std::array<std::string_view, 3> kNames = {"bt601", "bt709", "bt2020"};
  return kNames;
}

std::span<const std::string_view> enum_names(ColorRange) {
  static constexpr std::array<std::string_view, 2> kNames = {"limited", "full"};
  return kNames;
}

std::unique_ptr<VideoFile> open_video(const std::string& file, const VideoColors& colors) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw DataError(file + ": no such file; expected a video");
  std::string problem;
  std::unique_ptr<VideoFile> video = library().open_video(file, colors, problem);
  if (!video) throw DataError(fmt::format("{}: {}", file, problem));
  return video;
}

std::unique_ptr<VideoWriter> create_video(const std::string& file, cv::Size size,
                                          double frame_rate) {
  std::string problem;
  std::unique_ptr<VideoWriter> video = library().create_video(file, size, frame_rate, problem);
  if (!video) throw OutputError(fmt::format("{}: {}", file, problem));
  return video;
}

}  // namespace hypotrack
