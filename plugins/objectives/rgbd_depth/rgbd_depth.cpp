#include "rgbd_depth.hpp"

#include <fmt/format.h>

#include "hypotrack/error.hpp"

namespace hypotrack::rgbd_depth {
namespace {

constexpr double kCentimetresPerMetre = 100;  // the papers' unit of depth, which lambda belongs to
constexpr double kEpsilon = 1e-6;

void check_image(const cv::Mat& image, int type, const TileView& view, std::size_t index,
                 const char* what) {
  const bool fits = image.cols == view.camera.width && image.rows == view.camera.height;
  if (fits && image.type() == type) return;
  throw DataError(fmt::format(
      "objective rgbd_depth: the {} of view {} is {}x{} of OpenCV type {}; expected {}x{}, the "
      "size of its tile, of type {}",
      what, index, image.cols, image.rows, image.type(), view.camera.width, view.camera.height,
      type));
}

[[noreturn]] void lacks(const Observation& observation, std::size_t index, const char* what) {
  throw DataError(
      fmt::format("objective rgbd_depth: view {1} of frame {0} has depth but no {2}; expected one "
                  "for `foreground: {2}`. Use a source that gives it, or `foreground: depth`",
                  observation.frame, index, what));
}

void check_view(const Observation& observation, std::size_t index, Foreground foreground) {
  const TileView& view = observation.views[index];
  check_image(view.depth, CV_32FC1, view, index, "depth image");
  check_image(view.valid, CV_8UC1, view, index, "valid image");
  if (!view.mask.empty()) check_image(view.mask, CV_8UC1, view, index, "mask");
  if (foreground == Foreground::mask && view.mask.empty()) lacks(observation, index, "mask");
  if (foreground != Foreground::skin) return;
  if (view.color.empty()) lacks(observation, index, "colour");
  check_image(view.color, CV_8UC3, view, index, "colour image");
}

}  // namespace

std::span<const std::string_view> enum_names(Foreground) {
  static constexpr std::string_view kNames[] = {"auto", "mask", "depth", "skin"};
  return kNames;
}

RgbdDepth::RgbdDepth(const Params& params) : params_(params) {}

void RgbdDepth::prepare(const Observation& observation) {
  views_.clear();
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (view.depth.empty()) continue;
    check_view(observation, i, params_.foreground);
    const DepthRange range =
        depth_range(*observation.scene, observation.start, view.camera, params_.range);
    views_.push_back({i, observe(view, params_.foreground, range)});
  }
  if (views_.empty()) {
    throw DataError(fmt::format(
        "objective rgbd_depth: frame {} has {} view{}, none with depth; expected one that has. Use "
        "a source of depth images, or an objective that works on colour",
        observation.frame, observation.views.size(), observation.views.size() == 1 ? "" : "s"));
  }
  fingers_ = adjacent_fingers(*observation.scene);
}

double RgbdDepth::cost(const RenderedHypothesis& hypothesis) const {
  check_tiles(hypothesis);
  double closeness = 0, charged = 0, matched = 0, covered_or_foreground = 0;
  for (const PreparedView& view : views_) {
    const Agreement a =
        compare(view.observed.pixels, hypothesis.views[view.index],
                static_cast<float>(params_.d_max), static_cast<float>(params_.d_match));
    // Every pixel that may differ is charged d_M; closeness is what agreement gives back.
    charged += static_cast<double>(view.observed.measured + a.beyond);
    closeness += a.closeness;
    matched += static_cast<double>(a.matched);
    covered_or_foreground += static_cast<double>(view.observed.foreground + a.beyond);
  }
  const double difference = kCentimetresPerMetre * (params_.d_max * charged - closeness);
  const double both = matched + covered_or_foreground;
  const double silhouette = both > 0 ? 1 - 2 * matched / both : 1;
  return difference / (covered_or_foreground + kEpsilon) + params_.lambda * silhouette +
         params_.lambda_k * finger_crossing(fingers_, hypothesis.state);
}

void RgbdDepth::check_tiles(const RenderedHypothesis& hypothesis) const {
  for (const PreparedView& view : views_) {
    const auto& plane = view.observed.pixels;
    if (hypothesis.views.size() > view.index &&
        hypothesis.views[view.index].width == plane.width() &&
        hypothesis.views[view.index].height == plane.height()) {
      continue;
    }
    throw DataError(fmt::format(
        "objective rgbd_depth: a hypothesis drawn in {} views does not match the prepared frame; "
        "expected a {}x{} tile as view {}",
        hypothesis.views.size(), plane.width(), plane.height(), view.index));
  }
}

}  // namespace hypotrack::rgbd_depth
