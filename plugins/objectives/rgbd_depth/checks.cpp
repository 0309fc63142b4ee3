#include <fmt/format.h>

#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {
namespace {

/// The images that a view has.
struct Has {
  bool depth, mask, color;
};

void check_image(const cv::Mat& image, int type, const TileView& view, std::size_t index,
                 const char* what) {
  check_tile_image("rgbd_depth", image, type, view, index, what);
}

void check_images(const TileView& view, std::size_t index, Foreground foreground) {
  check_image(view.depth, CV_32FC1, view, index, "depth image");
  check_image(view.valid, CV_8UC1, view, index, "valid image");
  if (!view.mask.empty()) check_image(view.mask, CV_8UC1, view, index, "mask");
  if (foreground == Foreground::skin) {
    check_image(view.color, CV_8UC3, view, index, "colour image");
  }
}

[[noreturn]] void lacks(const Observation& observation, std::size_t index, const char* what) {
  throw DataError(
      fmt::format("objective rgbd_depth: view {1} of frame {0} has depth but no {2}; expected one "
                  "for `foreground: {2}`. Use a source that gives it, or `foreground: depth`",
                  observation.frame, index, what));
}

/// Checks all views; has(i) returns the images of view i.
template <class HasOf>
void check_views(const Observation& observation, Foreground foreground, const HasOf& has) {
  const std::size_t count = observation.views.size();
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    const Has view = has(i);
    if (!view.depth) continue;
    any = true;
    if (foreground == Foreground::mask && !view.mask) lacks(observation, i, "mask");
    if (foreground == Foreground::skin && !view.color) lacks(observation, i, "colour");
  }
  if (any) return;
  throw DataError(fmt::format(
      "objective rgbd_depth: frame {} has {} view{}, none with depth; expected one that has. Use "
      "a source of depth images, or an objective that works on colour",
      observation.frame, count, count == 1 ? "" : "s"));
}

}  // namespace

void check(const Observation& observation, Foreground foreground) {
  check_views(observation, foreground, [&](std::size_t i) {
    const TileView& view = observation.views[i];
    return Has{!view.depth.empty(), !view.mask.empty(), !view.color.empty()};
  });
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (!view.depth.empty()) check_images(view, i, foreground);
  }
}

void check(const cuda::DeviceObservation& observation, Foreground foreground) {
  check_views(*observation.header, foreground, [&](std::size_t i) {
    const cuda::DeviceTile& tile = observation.tiles[i];
    return Has{tile.layout.depth != nullptr, tile.has_mask, tile.has_color};
  });
}

}  // namespace hypotrack::rgbd_depth
