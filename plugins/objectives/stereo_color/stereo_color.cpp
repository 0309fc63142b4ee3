#include "stereo_color.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "residuals.hpp"
#include "score.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {
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
std::span<const std::string_view> enum_names(Falloff) {
  static constexpr std::string_view kNames[] = {"exponential", "gaussian"};
  return kNames;
}
std::span<const std::string_view> enum_names(Lookup) {
  static constexpr std::string_view kNames[] = {"nearest", "bilinear"};
  return kNames;
}

StereoColor::StereoColor(const Params& params) : params_(params), of_frame_(params) {
  if (params.beta_min > params.beta_max)
    throw ConfigError(fmt::format(
        "stereo_color: beta_min is {}, above beta_max, {}; swap them or widen the range",
        params.beta_min, params.beta_max));
  if (params.gray_weight < 1 && params.color_space != ColorSpace::rgb)
    throw ConfigError(fmt::format(
        "stereo_color: gray_weight is {}, which is for color_space: rgb only; found color_space: "
        "{}. Leave one of them as it is by default",
        params.gray_weight,
        enum_names(params.color_space)[static_cast<std::size_t>(params.color_space)]));
}

ImageUse StereoColor::do_image_use() const { return {.mask = params_.use_mask, .depth = false}; }

void StereoColor::do_prepare(const Observation& observation) {
  check(observation);
  of_frame_.beta = beta_of(params_, observation);
  tbb::parallel_for(std::size_t{0}, std::size_t{2}, [&](std::size_t i) {
    features_[i] = make_features(observation.views[i], params_);
    maps_[i] = stereo_map(observation, static_cast<int>(i), static_cast<int>(1 - i));
    if (do_residual_term() && uses(i)) uncovered_[i] = uncovered_residuals(features_[i], share());
  });
}

void StereoColor::check_tiles(const RenderedHypothesis& hypothesis) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& plane = features_[i].channels_01;
    check_drawn_tile("stereo_color", hypothesis, i, plane.width(), plane.height());
  }
}

double StereoColor::do_cost(const RenderedHypothesis& hypothesis) const {
  check_tiles(hypothesis);
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!uses(i)) continue;
    sum += score(measure({features_[i], hypothesis.views[i]},
                         {features_[1 - i], hypothesis.views[1 - i]}, maps_[i], of_frame_));
  }
  return cost_of(sum);
}

std::unique_ptr<cuda::DeviceObjective> StereoColor::do_on_device() const {
  return make_device_objective(params_);
}

std::vector<PixelMap> StereoColor::do_maps(const RenderedHypothesis& hypothesis) const {
  check_tiles(hypothesis);
  constexpr float kFallen = 3;  // x at which exp(-x) is 5 %
  const auto beta = static_cast<float>(of_frame_.beta);
  const bool gaussian = params_.falloff == Falloff::gaussian;
  const float farthest = (gaussian ? std::sqrt(kFallen) : kFallen) / beta;
  std::vector<PixelMap> maps;
  for (std::size_t i = 0; i < 2; ++i) {
    const int view = static_cast<int>(i);
    if (params_.distinctiveness != Distinctiveness::none)
      maps.push_back({"distinctiveness", view, weight_map(features_[i])});
    if (!uses(i)) continue;
    ScoreMaps found = score_maps({features_[i], hypothesis.views[i]},
                                 {features_[1 - i], hypothesis.views[1 - i]}, maps_[i], of_frame_);
    maps.push_back({"colour difference", view, std::move(found.difference), 0, farthest});
    maps.push_back({"consistency", view, std::move(found.consistency)});
  }
  return maps;
}

bool StereoColor::uses(std::size_t from) const {
  return params_.direction != (from == 0 ? Direction::right_to_left : Direction::left_to_right);
}

float StereoColor::share() const { return params_.direction == Direction::both ? 0.5f : 1.0f; }

const ResidualTerm* StereoColor::do_residual_term() const {
  return params_.aggregation == Aggregation::sum ? this : nullptr;
}

std::int64_t StereoColor::do_residual_count() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& plane = features_[i].channels_01;
    if (uses(i)) count += std::int64_t{plane.width()} * plane.height();
  }
  return count;
}

void StereoColor::do_write_residuals(const RenderedHypothesis& hypothesis,
                                     std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double StereoColor::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                          std::span<float> residuals) const {
  check_tiles(hypothesis);
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!uses(i)) continue;
    const auto& plane = uncovered_[i];
    const auto size = static_cast<std::size_t>(plane.width()) * plane.height();
    const Similarity similarity = stereo_color::write_residuals(
        {features_[i], hypothesis.views[i]}, {features_[1 - i], hypothesis.views[1 - i]}, maps_[i],
        of_frame_, share(), uncovered_[i], residuals.first(size));
    sum += score(similarity);
    residuals = residuals.subspan(size);
  }
  return cost_of(sum);
}

std::span<const int> StereoColor::do_pixel_views() const {
  static constexpr std::array<int, 2> kViews{0, 1};
  const std::span<const int> views(kViews);
  if (params_.direction == Direction::both) return views;
  return views.subspan(uses(0) ? 0 : 1, 1);
}

void StereoColor::do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                                  std::span<float> residuals, std::span<float> slopes) const {
  check_tiles(hypothesis);
  const auto here = static_cast<std::size_t>(do_pixel_views()[i]);
  stereo_color::write_slopes({features_[here], hypothesis.views[here]},
                             {features_[1 - here], hypothesis.views[1 - here]}, maps_[here],
                             of_frame_, share(), uncovered_[here], residuals, slopes);
}

double StereoColor::score(const Similarity& similarity) const {
  return aggregate(params_.aggregation, similarity.sum, static_cast<double>(similarity.seen),
                   static_cast<double>(similarity.rendered));
}

double StereoColor::cost_of(double scores) const {
  return 0.0 - double{share()} * scores;  // not -0.0
}

}  // namespace hypotrack::stereo_color
