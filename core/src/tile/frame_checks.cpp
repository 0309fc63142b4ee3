#include <fmt/format.h>

#include <cstddef>
#include <opencv2/core.hpp>
#include <string>

#include "hypotrack/api/error.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::internal {
namespace {

void check_image(const cv::Mat& image, int type, const char* what, const char* expected,
                 const Camera& camera, const std::string& where) {
  if (image.empty()) return;
  if (image.cols != camera.width || image.rows != camera.height) {
    throw DataError(
        fmt::format("{}: the {} is {}x{} pixels, its camera {}x{}; expected the same size", where,
                    what, image.cols, image.rows, camera.width, camera.height));
  }
  if (image.type() != type) {
    throw DataError(fmt::format("{}: the {} is of OpenCV type {}; expected {}", where, what,
                                cv::typeToString(image.type()), expected));
  }
}

void check_view(const Frame& frame, std::size_t index, const Camera& camera) {
  const View& view = frame.views[index];
  const std::string where = fmt::format("frame {}, view {}", frame.index, index);
  if (view.color.empty() && view.depth.empty()) {
    throw DataError(
        fmt::format("{}: there is neither colour nor depth; expected at least one of them", where));
  }
  check_image(view.color, CV_8UC3, "image", "8-bit BGR", camera, where);
  check_image(view.mask, CV_8UC1, "mask", "8 bits and one channel", camera, where);
  check_image(view.depth, CV_32FC1, "depth image", "metres as 32-bit floats, one channel", camera,
              where);
}

}  // namespace

void check_views(const Frame& frame, const std::vector<Camera>& cameras) {
  const std::size_t found = frame.views.size();
  if (found != cameras.size()) {
    throw DataError(fmt::format("frame {} has {} views; expected {}, one per camera", frame.index,
                                found, cameras.size()));
  }
  for (std::size_t i = 0; i < found; ++i) check_view(frame, i, cameras[i]);
}

}  // namespace hypotrack::internal
