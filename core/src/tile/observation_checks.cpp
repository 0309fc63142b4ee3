#include <fmt/format.h>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack {
namespace {

void check_count(std::string_view objective, const Observation& observation) {
  if (observation.views.size() >= 2) return;
  throw DataError(
      fmt::format("objective {}: frame {} has {} view{}; expected two calibrated "
                  "views. Use a stereo source, or an objective that needs one view only",
                  objective, observation.frame, observation.views.size(),
                  observation.views.size() == 1 ? "" : "s"));
}

void check_view(std::string_view objective, const TileView& view, std::size_t index,
                bool has_color) {
  if (view.camera.width < 2 || view.camera.height < 2) {
    throw DataError(
        fmt::format("objective {}: the tile of view {} is {}x{} pixels; "
                    "expected 2x2 or more",
                    objective, index, view.camera.width, view.camera.height));
  }
  if (!has_color) {
    throw DataError(
        fmt::format("objective {}: view {} has no colour; expected colour images of both cameras. "
                    "Use a stereo source, or an objective for depth",
                    objective, index));
  }
}

}  // namespace

void check_tile_image(std::string_view objective, const cv::Mat& image, int type,
                      const TileView& view, std::size_t index, const char* what) {
  const bool fits = image.cols == view.camera.width && image.rows == view.camera.height;
  if (fits && image.type() == type) return;
  throw DataError(
      fmt::format("objective {}: the {} of view {} is {}x{} of OpenCV type {}; expected {}x{}, the "
                  "size of its tile, of type {}",
                  objective, what, index, image.cols, image.rows, image.type(), view.camera.width,
                  view.camera.height, type));
}

void check_color_pair(std::string_view objective, const Observation& observation) {
  check_count(objective, observation);
  for (std::size_t i = 0; i < 2; ++i) {
    const TileView& view = observation.views[i];
    check_view(objective, view, i, !view.color.empty());
    check_tile_image(objective, view.color, CV_8UC3, view, i, "colour image");
    check_tile_image(objective, view.valid, CV_8UC1, view, i, "valid image");
    if (!view.mask.empty()) check_tile_image(objective, view.mask, CV_8UC1, view, i, "mask");
  }
}

void check_color_pair(std::string_view objective, const Observation& header,
                      const bool (&has_color)[2]) {
  check_count(objective, header);
  for (std::size_t i = 0; i < 2; ++i) check_view(objective, header.views[i], i, has_color[i]);
}

void check_drawn_tile(std::string_view objective, const RenderedHypothesis& hypothesis,
                      std::size_t index, int width, int height) {
  if (hypothesis.views.size() > index && hypothesis.views[index].width == width &&
      hypothesis.views[index].height == height) {
    return;
  }
  throw DataError(
      fmt::format("objective {}: a hypothesis drawn in {} views does not match the prepared frame; "
                  "expected a {}x{} tile as view {}",
                  objective, hypothesis.views.size(), width, height, index));
}

}  // namespace hypotrack
