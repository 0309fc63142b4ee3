#include "hypotrack/api/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/kept_results.hpp"
#include "camera/pictures/orientation.hpp"

namespace hypotrack {
namespace {

/// What an image is read as, and by which number: bits of a colour picture, metres of depth.
enum class Kind { color, mask, depth };
using ImageKey = std::tuple<FileVersion, Kind, double>;

KeptResults<ImageKey, ReadImage>& images() {
  static KeptResults<ImageKey, ReadImage> kept([](const ReadImage& read) {
    return read.problem.empty() ? read.image.total() * read.image.elemSize() : 0;
  });
  return kept;
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

/// Returns a kept image, or reads it.
template <class Read>
ReadImage kept(const std::filesystem::path& file, Kind kind, double number, const Read& read) {
  if (!images().keeps()) return within_memory(file, read);
  return images().get({version_of(file), kind, number}, [&] { return within_memory(file, read); });
}

/// Returns the words for the type of a file's pixels.
std::string_view words_for(int depth) {
  constexpr std::array<std::string_view, 8> kPixels = {
      "8-bit",          "signed 8-bit",   "16-bit",         "signed 16-bit",
      "32-bit integer", "floating-point", "floating-point", "floating-point"};
  return kPixels.at(static_cast<std::size_t>(depth));
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

void internal::keep_read_images(std::size_t bytes) { images().keep(bytes); }

ReadImage read_color(const std::filesystem::path& file, int bits) {
  return kept(file, Kind::color, bits, [&]() -> ReadImage {
    DecodedFile read = decode_upright(file);
    if (!read.problem.empty()) return read;
    if (read.image.depth() != CV_8U && read.image.depth() != CV_16U) {
      return {{},
              fmt::format("{}: has {} pixels; expected 8 or 16 bits", file.string(),
                          words_for(read.image.depth()))};
    }
    read.image = to_bgr(read.image);
    if (read.image.depth() == CV_16U) {
      const double given = std::exp2(bits) - 1;
      const double white = read.white ? std::min<double>(*read.white, given) : given;
      read.image.convertTo(read.image, CV_8U, 255 / white);
    }
    return read;
  });
}

ReadImage read_mask(const std::filesystem::path& file) {
  return kept(file, Kind::mask, 0, [&]() -> ReadImage {
    ReadImage read = decode_upright(file);
    if (!read.problem.empty()) return read;
    if (read.image.channels() == 1) {
      read.image = read.image != 0;
      return read;
    }
    std::vector<cv::Mat> channels;
    cv::split(to_bgr(read.image), channels);
    cv::Mat any = channels[0] != 0;
    any |= channels[1] != 0;
    any |= channels[2] != 0;
    if (const int count = read.image.channels(); count % 2 == 0) {
      cv::extractChannel(read.image, channels[0], count - 1);
      if (cv::countNonZero(channels[0]) > 0) any &= channels[0] != 0;
    }
    read.image = any;
    return read;
  });
}

ReadImage read_depth(const std::filesystem::path& file, double unit) {
  return kept(file, Kind::depth, unit, [&]() -> ReadImage {
    ReadImage read = decode_upright(file);
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
  return fmt::format("{}: is {}x{} pixels; expected {}x{} as its camera{}", file.string(),
                     image.cols, image.rows, camera.width, camera.height,
                     advice_on_turn(image.cols, image.rows, camera.width, camera.height));
}

}  // namespace hypotrack
