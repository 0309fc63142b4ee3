#include "stereo_color.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "hypotrack/error.hpp"

namespace hypotrack::stereo_color {
namespace {

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

void check_view(const TileView& view, std::size_t index) {
  if (view.camera.width < 2 || view.camera.height < 2) {
    throw DataError(
        fmt::format("objective stereo_color: the tile of view {} is {}x{} pixels; "
                    "expected 2x2 or more",
                    index, view.camera.width, view.camera.height));
  }
  if (view.color.empty()) {
    throw DataError(fmt::format(
        "objective stereo_color: view {} has no colour; expected colour images of both cameras. "
        "Use a stereo source, or an objective for depth",
        index));
  }
  check_image(view.color, CV_8UC3, view, index, "colour image");
  check_image(view.valid, CV_8UC1, view, index, "valid image");
  if (!view.mask.empty()) check_image(view.mask, CV_8UC1, view, index, "mask");
}

double aggregate(const Similarity& s, Aggregation aggregation) {
  const auto ratio = [&](double n) { return n > 0 ? s.sum / n : 0.0; };
  switch (aggregation) {
    case Aggregation::sum:
      return s.sum;
    case Aggregation::mean_seen:
      return ratio(static_cast<double>(s.seen));
    case Aggregation::mean_rendered:
      return ratio(static_cast<double>(s.rendered));
    case Aggregation::sum_per_sqrt:
      return ratio(std::sqrt(static_cast<double>(s.rendered)));
  }
  return 0;
}

}  // namespace

std::span<const std::string_view> enum_names(ColorSpace) {
  static constexpr std::string_view kNames[] = {"rgb", "lab", "hsv", "gray"};
  return kNames;
}
std::span<const std::string_view> enum_names(Distinctiveness) {
  static constexpr std::string_view kNames[] = {"principal_curvatures", "none"};
  return kNames;
}
std::span<const std::string_view> enum_names(Aggregation) {
  static constexpr std::string_view kNames[] = {"sum", "mean_seen", "mean_rendered",
                                                "sum_per_sqrt"};
  return kNames;
}
std::span<const std::string_view> enum_names(Direction) {
  static constexpr std::string_view kNames[] = {"left_to_right", "right_to_left", "both"};
  return kNames;
}
std::span<const std::string_view> enum_names(Lookup) {
  static constexpr std::string_view kNames[] = {"nearest", "bilinear"};
  return kNames;
}

StereoColor::StereoColor(const Params& params) : params_(params) {}

void StereoColor::prepare(const Observation& observation) {
  if (observation.views.size() < 2) {
    throw DataError(fmt::format(
        "objective stereo_color: frame {} has {} view{}; expected two calibrated "
        "views. Use a stereo source, or an objective that needs one view only",
        observation.frame, observation.views.size(), observation.views.size() == 1 ? "" : "s"));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    check_view(observation.views[i], i);
    features_[i] = make_features(observation.views[i], params_);
    maps_[i] = stereo_map(observation, static_cast<int>(i), static_cast<int>(1 - i));
  }
}

double StereoColor::cost(const RenderedHypothesis& hypothesis) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& plane = features_[i].channels_01;
    if (hypothesis.views.size() > i && hypothesis.views[i].width == plane.width() &&
        hypothesis.views[i].height == plane.height()) {
      continue;
    }
    throw DataError(fmt::format(
        "objective stereo_color: a hypothesis drawn in {} views does not match the prepared frame; "
        "expected a {}x{} tile as view {}",
        hypothesis.views.size(), plane.width(), plane.height(), i));
  }
  switch (params_.direction) {
    case Direction::left_to_right:
      return 0.0 - score(hypothesis, 0, 1);  // not -0.0
    case Direction::right_to_left:
      return 0.0 - score(hypothesis, 1, 0);
    case Direction::both:
      return 0.0 - 0.5 * (score(hypothesis, 0, 1) + score(hypothesis, 1, 0));
  }
  return 0;
}

double StereoColor::score(const RenderedHypothesis& hypothesis, int from, int to) const {
  const auto a = static_cast<std::size_t>(from);
  const auto b = static_cast<std::size_t>(to);
  const Similarity similarity = measure({features_[a], hypothesis.views[a]},
                                        {features_[b], hypothesis.views[b]}, maps_[a], params_);
  return aggregate(similarity, params_.aggregation);
}

}  // namespace hypotrack::stereo_color
