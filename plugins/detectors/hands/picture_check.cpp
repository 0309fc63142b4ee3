#include "picture_check.hpp"

#include <fmt/format.h>

#include <array>
#include <opencv2/core.hpp>

#include "hypotrack/error.hpp"

namespace hypotrack::hands {
namespace {

bool equal(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

/// Returns a grey picture in shades of skin.
cv::Mat tinted(const cv::Mat& grey) {
  constexpr std::array<double, 3> kShade = {0.6, 0.75, 1};  // blue, green, red
  std::array<cv::Mat, 3> channels;
  for (std::size_t i = 0; i < 3; ++i) grey.convertTo(channels[i], CV_8U, kShade[i]);
  cv::Mat out;
  cv::merge(channels.data(), channels.size(), out);
  return out;
}

}  // namespace

cv::Mat checked_color(const cv::Mat& picture) {
  if (picture.empty()) throw DataError("the hand detector was given an empty picture");
  if (picture.dims != 2 || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)) {
    throw DataError(
        fmt::format("the hand detector was given a picture of {}; expected 8-bit BGR or grey",
                    cv::typeToString(picture.type())));
  }
  if (picture.channels() == 1) return tinted(picture);
  std::array<cv::Mat, 3> channels;
  cv::split(picture, channels.data());
  const bool grey = equal(channels[0], channels[1]) && equal(channels[1], channels[2]);
  return grey ? tinted(channels[0]) : picture;
}

}  // namespace hypotrack::hands
