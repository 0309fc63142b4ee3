#include "hypotrack/api/stereo_layout.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"

namespace hypotrack {

std::span<const std::string_view> enum_names(StereoLayout) {
  static constexpr std::array<std::string_view, 2> kNames = {"side_by_side", "top_bottom"};
  return kNames;
}

ImageSize view_size(StereoLayout layout, int width, int height, std::string_view where) {
  const bool beside = layout == StereoLayout::side_by_side;
  if ((beside ? width : height) % 2 == 0)
    return {beside ? width / 2 : width, beside ? height : height / 2};
  throw DataError(
      fmt::format("{}: its picture is {} pixels {}; expected an even number, half for each view",
                  where, beside ? width : height, beside ? "wide" : "high"));
}

std::array<cv::Mat, 2> split_views(StereoLayout layout, const cv::Mat& picture) {
  const cv::Size half = layout == StereoLayout::side_by_side
                            ? cv::Size(picture.cols / 2, picture.rows)
                            : cv::Size(picture.cols, picture.rows / 2);
  const cv::Point second =
      layout == StereoLayout::side_by_side ? cv::Point(half.width, 0) : cv::Point(0, half.height);
  return {picture(cv::Rect({0, 0}, half)).clone(), picture(cv::Rect(second, half)).clone()};
}

}  // namespace hypotrack
