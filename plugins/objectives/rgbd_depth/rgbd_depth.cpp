#include "rgbd_depth.hpp"

#include "energy.hpp"
#include "foreground.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "settings.hpp"

namespace hypotrack::rgbd_depth {
std::span<const std::string_view> enum_names(Foreground) {
  static constexpr std::string_view kNames[] = {"auto", "mask", "depth", "skin"};
  return kNames;
}

RgbdDepth::RgbdDepth(const Params& params) : params_(params) {}

ImageUse RgbdDepth::do_image_use() const {
  const Foreground by = params_.foreground;
  return {.mask = by == Foreground::automatic || by == Foreground::mask, .depth = true};
}

void RgbdDepth::do_prepare(const Observation& observation) {
  views_.clear();
  check(observation, params_.foreground);
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (view.depth.empty()) continue;
    DepthRange range;
    if (rule_of(params_.foreground, !view.mask.empty()) != Rule::mask) {
      range = depth_range(*observation.scene, observation.start, view.camera, params_.range);
    }
    views_.push_back({i, observe(view, params_.foreground, range), {}});
  }
  price_pixels();
  fingers_ = adjacent_fingers(*observation.scene);
}

void RgbdDepth::price_pixels() {
  std::int64_t foreground = 0;
  for (const PreparedView& view : views_) foreground += view.observed.foreground;
  penalties_ = pixel_penalties(static_cast<float>(foreground), weights());
  for (PreparedView& view : views_) {
    view.uncovered = uncovered_residuals(view.observed.pixels, penalties_);
  }
}

std::int64_t RgbdDepth::do_residual_count() const {
  auto count = static_cast<std::int64_t>(fingers_.size());
  for (const PreparedView& view : views_) {
    count += std::int64_t{view.uncovered.width()} * view.uncovered.height();
  }
  return count;
}

void RgbdDepth::do_write_residuals(const RenderedHypothesis& hypothesis,
                                   std::span<float> residuals) const {
  check_tiles(hypothesis);
  for (const PreparedView& view : views_) {
    const auto size = static_cast<std::size_t>(view.uncovered.width()) * view.uncovered.height();
    rgbd_depth::write_residuals(view.observed.pixels, hypothesis.views[view.index],
                                static_cast<float>(params_.d_max), penalties_, view.uncovered,
                                residuals.first(size));
    residuals = residuals.subspan(size);
  }
  for (std::size_t i = 0; i < fingers_.size(); ++i) {
    const double crossing = finger_crossing(&fingers_[i], 1, hypothesis.state.data());
    residuals[i] = crossing_residual(crossing, weights());
  }
}

double RgbdDepth::do_cost(const RenderedHypothesis& hypothesis) const {
  check_tiles(hypothesis);
  Totals totals{};
  for (const PreparedView& view : views_) {
    const Agreement a =
        compare(view.observed.pixels, hypothesis.views[view.index],
                static_cast<float>(params_.d_max), static_cast<float>(params_.d_match));
    totals.foreground += static_cast<double>(view.observed.foreground);
    totals.measured += static_cast<double>(view.observed.measured);
    totals.closeness += a.closeness;
    totals.matched += static_cast<double>(a.matched);
    totals.beyond += static_cast<double>(a.beyond);
  }
  const double crossing =
      finger_crossing(fingers_.data(), static_cast<int>(fingers_.size()), hypothesis.state.data());
  return energy(totals, crossing, weights());
}

Weights RgbdDepth::weights() const { return {params_.d_max, params_.lambda, params_.lambda_k}; }

std::unique_ptr<cuda::DeviceObjective> RgbdDepth::do_on_device() const {
  return make_device_objective(params_);
}

void RgbdDepth::check_tiles(const RenderedHypothesis& hypothesis) const {
  for (const PreparedView& view : views_) {
    const auto& plane = view.observed.pixels;
    check_drawn_tile("rgbd_depth", hypothesis, view.index, plane.width(), plane.height());
  }
}

}  // namespace hypotrack::rgbd_depth
