#include "skin.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "rule.hpp"
#include "score.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

std::span<const std::string_view> enum_names(Foreground) {
  static constexpr std::string_view kNames[] = {"auto", "color", "mask", "depth"};
  return kNames;
}

Skin::Skin(const Params& params) : params_(params) {}

ImageUse Skin::do_image_use() const {
  const Foreground by = params_.foreground;
  return {.mask = by == Foreground::automatic || by == Foreground::mask,
          .depth = by == Foreground::depth,
          .background = params_.still_cameras};
}

void Skin::do_prepare(const Observation& observation) {
  views_.clear();
  view_numbers_.clear();
  check(observation, params_.foreground);
  while (estimators_.size() < observation.views.size()) estimators_.emplace_back(params_);
  std::vector<ViewForeground> foregrounds(observation.views.size());
  tbb::parallel_for(std::size_t{0}, foregrounds.size(), [&](std::size_t i) {
    foregrounds[i] = estimators_[i].estimate(observation, i);
  });
  for (std::size_t i = 0; i < foregrounds.size(); ++i) {
    if (foregrounds[i].pixels.width() == 0) continue;
    views_.push_back({i, std::move(foregrounds[i]), {}});
    view_numbers_.push_back(static_cast<int>(i));
  }
  for (PreparedView& view : views_) {
    view.uncovered = uncovered_residuals(view.foreground.pixels, share());
  }
}

float Skin::share() const { return 1.0f / static_cast<float>(views_.size()); }

double Skin::do_cost(const RenderedHypothesis& hypothesis) const {
  double sum = 0;
  for (const PreparedView& view : views_) {
    const auto& plane = view.foreground.pixels;
    check_drawn_tile("skin", hypothesis, view.index, plane.width(), plane.height());
    sum += view.foreground.sum +
           sum_covered(plane, hypothesis.views[view.index], static_cast<float>(params_.spill));
  }
  return sum / static_cast<double>(views_.size());
}

std::unique_ptr<cuda::DeviceObjective> Skin::do_on_device() const {
  return make_device_objective(params_);
}

std::int64_t Skin::do_residual_count() const {
  std::int64_t count = 0;
  for (const PreparedView& view : views_) {
    count += std::int64_t{view.uncovered.width()} * view.uncovered.height();
  }
  return count;
}

void Skin::do_write_residuals(const RenderedHypothesis& hypothesis,
                              std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double Skin::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                   std::span<float> residuals) const {
  double sum = 0;
  for (const PreparedView& view : views_) {
    const auto size = static_cast<std::size_t>(view.uncovered.width()) * view.uncovered.height();
    sum += measure(view, hypothesis, residuals.first(size));
    residuals = residuals.subspan(size);
  }
  return sum / static_cast<double>(views_.size());
}

void Skin::do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                           std::span<float> residuals, std::span<float> slopes) const {
  measure(views_[i], hypothesis, residuals);
  std::ranges::fill(slopes, 0.0f);
}

double Skin::measure(const PreparedView& view, const RenderedHypothesis& hypothesis,
                     std::span<float> residuals) const {
  const auto& plane = view.foreground.pixels;
  check_drawn_tile("skin", hypothesis, view.index, plane.width(), plane.height());
  return view.foreground.sum + skin::write_residuals(plane, hypothesis.views[view.index],
                                                     static_cast<float>(params_.spill), share(),
                                                     view.uncovered, residuals);
}

}  // namespace hypotrack::skin
