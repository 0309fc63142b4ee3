#include "tile/frame_checks.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <opencv2/core.hpp>

#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

void check_image(const cv::Mat& image, int type, const char* what, const char* expected,
                 const Camera& camera, std::size_t view) {
  if (image.empty()) return;
  if (image.cols != camera.width || image.rows != camera.height) {
    throw DataError(
        fmt::format("view {}: the {} is {}x{} pixels, its camera {}x{}; expected the same size",
                    view, what, image.cols, image.rows, camera.width, camera.height));
  }
  if (image.type() != type) {
    throw DataError(fmt::format("view {}: the {} is of OpenCV type {}; expected {}", view, what,
                                cv::typeToString(image.type()), expected));
  }
}

void check_view(const View& view, std::size_t index, const Camera& camera) {
  if (view.color.empty() && view.depth.empty()) {
    throw DataError(fmt::format(
        "view {}: there is neither colour nor depth; expected at least one of them", index));
  }
  check_image(view.color, CV_8UC3, "image", "8-bit BGR", camera, index);
  check_image(view.mask, CV_8UC1, "mask", "8 bits and one channel", camera, index);
  check_image(view.depth, CV_32FC1, "depth image", "metres as 32-bit floats, one channel", camera,
              index);
}

}  // namespace

void check_views(const Frame& frame, const std::vector<Camera>& cameras) {
  const std::size_t found = frame.views.size();
  if (found != cameras.size()) {
    throw DataError(fmt::format("there {} {} view{}; expected {}, one per camera",
                                found == 1 ? "is" : "are", found, found == 1 ? "" : "s",
                                cameras.size()));
  }
  for (std::size_t i = 0; i < found; ++i) check_view(frame.views[i], i, cameras[i]);
}

}  // namespace hypotrack
