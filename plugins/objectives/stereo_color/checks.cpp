#include "checks.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::stereo_color {
namespace {

void check_count(const Observation& observation) {
  if (observation.views.size() < 2) {
    throw DataError(fmt::format(
        "objective stereo_color: frame {} has {} view{}; expected two calibrated "
        "views. Use a stereo source, or an objective that needs one view only",
        observation.frame, observation.views.size(), observation.views.size() == 1 ? "" : "s"));
  }
}

void check_image(const cv::Mat& image, int type, const TileView& view, std::size_t index,
                 const char* what) {
  const bool fits = image.cols == view.camera.width && image.rows == view.camera.height;
  if (fits && image.type() == type) return;
  throw DataError(fmt::format(
      "objective stereo_color: the {} of view {} is {}x{} of OpenCV type {}; expected {}x{}, the "
      "size of its tile, of type {}",
      what, index, image.cols, image.rows, image.type(), view.camera.width, view.camera.height,
      type));
}

void check_view(const TileView& view, std::size_t index, bool has_color) {
  if (view.camera.width < 2 || view.camera.height < 2) {
    throw DataError(
        fmt::format("objective stereo_color: the tile of view {} is {}x{} pixels; "
                    "expected 2x2 or more",
                    index, view.camera.width, view.camera.height));
  }
  if (!has_color) {
    throw DataError(fmt::format(
        "objective stereo_color: view {} has no colour; expected colour images of both cameras. "
        "Use a stereo source, or an objective for depth",
        index));
  }
}

void check_images(const TileView& view, std::size_t index) {
  check_image(view.color, CV_8UC3, view, index, "colour image");
  check_image(view.valid, CV_8UC1, view, index, "valid image");
  if (!view.mask.empty()) check_image(view.mask, CV_8UC1, view, index, "mask");
}

}  // namespace

void check(const Observation& observation) {
  check_count(observation);
  for (std::size_t i = 0; i < 2; ++i) {
    const TileView& view = observation.views[i];
    check_view(view, i, !view.color.empty());
    check_images(view, i);
  }
}

void check(const cuda::DeviceObservation& observation) {
  check_count(*observation.header);
  for (std::size_t i = 0; i < 2; ++i) {
    check_view(observation.header->views[i], i, observation.tiles[i].has_color);
  }
}

}  // namespace hypotrack::stereo_color
