#include "hypotrack/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "camera/picture_header.hpp"
#include "hypotrack/media.hpp"
#include "hypotrack/text_file.hpp"

namespace hypotrack {
namespace {

constexpr std::uintmax_t kLargestImageFile = std::uintmax_t{512} << 20;

/// Returns true if a JPEG or PNG lacks its end marker. Decoders fill truncated images with grey.
bool is_truncated(std::string_view all) {
  const std::string_view tail = all.substr(all.size() - std::min<std::size_t>(all.size(), 4096));
  if (all.starts_with("\xFF\xD8\xFF")) return tail.find("\xFF\xD9") == std::string_view::npos;
  if (all.starts_with("\x89PNG\r\n")) return tail.find("IEND") == std::string_view::npos;
  return false;
}

ReadImage decode(const std::filesystem::path& file) {
  std::error_code error;
  const std::string name = file.string();
  if (!std::filesystem::exists(file, error)) return {{}, name + ": is missing"};
  if (!std::filesystem::is_regular_file(file, error)) return {{}, name + ": is no file"};
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestImageFile) return {{}, name + ": is larger than 512 MiB"};
  std::optional<std::string> all = read_whole(file);
  if (!all) return {{}, name + ": cannot be read; check its permissions"};
  if (all->empty()) return {{}, name + ": is empty"};
  if (is_truncated(*all)) return {{}, name + ": is cut off before its end"};
  if (const std::string problem = problem_of_size(*all); !problem.empty())
    return {{}, name + ": " + problem};
  ReadImage read;
  try {
    const cv::Mat bytes(1, static_cast<int>(all->size()), CV_8UC1, all->data());
    read.image = decode_image(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) throw;
    read.image.release();  // OpenCV's message for absurd sizes names its own source lines
  }
  if (read.image.empty()) read.problem = name + ": is damaged or no image";
  return read;
}

/// Calls a function that reads a file. Lack of memory is a problem of the file, but no damage.
template <class Read>
ReadImage within_memory(const std::filesystem::path& file, const Read& read) {
  try {
    return read();
  } catch (const cv::Exception& e) {
    if (e.code != cv::Error::StsNoMem) throw;
  } catch (const std::bad_alloc&) {
  }
  return {{}, file.string() + ": there is not enough memory to decode it"};
}

/// Converts an image to three channels of the same depth.
cv::Mat to_bgr(const cv::Mat& image) {
  cv::Mat bgr;
  switch (image.channels()) {
    case 1:
      cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
      return bgr;
    case 2:  // grey and alpha
      cv::extractChannel(image, bgr, 0);
      cv::cvtColor(bgr, bgr, cv::COLOR_GRAY2BGR);
      return bgr;
    case 4:
      cv::cvtColor(image, bgr, cv::COLOR_BGRA2BGR);
      return bgr;
    default:
      return image;
  }
}

}  // namespace

ReadImage read_color(const std::filesystem::path& file, int bits) {
  return within_memory(file, [&]() -> ReadImage {
    ReadImage read = decode(file);
    if (!read.problem.empty()) return read;
    if (read.image.depth() != CV_8U && read.image.depth() != CV_16U) {
      return {{}, file.string() + ": has floating-point pixels; expected 8 or 16 bits"};
    }
    read.image = to_bgr(read.image);
    if (read.image.depth() == CV_16U) {
      // The largest value of that many bits becomes 255.
      read.image.convertTo(read.image, CV_8U, 255.0 / (std::exp2(bits) - 1));
    }
    return read;
  });
}

ReadImage read_mask(const std::filesystem::path& file) {
  return within_memory(file, [&]() -> ReadImage {
    ReadImage read = decode(file);
    if (!read.problem.empty()) return read;
    std::vector<cv::Mat> channels;
    cv::split(to_bgr(read.image), channels);
    cv::Mat any = channels[0] != 0;
    any |= channels[1] != 0;
    any |= channels[2] != 0;
    read.image = any;
    return read;
  });
}

ReadImage read_depth(const std::filesystem::path& file, double unit) {
  return within_memory(file, [&]() -> ReadImage {
    ReadImage read = decode(file);
    if (!read.problem.empty()) return read;
    if (read.image.type() != CV_16UC1) {
      constexpr std::array<const char*, 8> kPixels = {"8-bit",         "8-bit signed",   "16-bit",
                                                      "16-bit signed", "32-bit integer", "float",
                                                      "double",        "half float"};
      return {{},
              fmt::format("{}: has {} pixels of {} channel{}; depth is 16 bits and one channel",
                          file.string(), kPixels[static_cast<std::size_t>(read.image.depth())],
                          read.image.channels(), read.image.channels() == 1 ? "" : "s")};
    }
    read.image.convertTo(read.image, CV_32F, unit);
    return read;
  });
}

std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                         const Camera& camera) {
  if (image.cols == camera.width && image.rows == camera.height) return {};
  return fmt::format("{}: is {}x{} pixels; expected {}x{} as its camera", file.string(), image.cols,
                     image.rows, camera.width, camera.height);
}

}  // namespace hypotrack
