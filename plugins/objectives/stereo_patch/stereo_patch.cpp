#include "stereo_patch.hpp"

#include <array>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "score.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_patch {

std::span<const std::string_view> enum_names(Measure) {
  static constexpr std::string_view kNames[] = {"zncc", "census"};
  return kNames;
}

StereoPatch::StereoPatch(const Params& params) : params_(params) {}

ImageUse StereoPatch::do_image_use() const { return {.mask = params_.use_mask, .depth = false}; }

void StereoPatch::do_prepare(const Observation& observation) {
  check_color_pair("stereo_patch", observation);
  map_ = stereo_map(observation, 0, 1);
  make_volume(observation, params_, volume_);
}

void StereoPatch::check_tiles(const RenderedHypothesis& hypothesis) const {
  check_drawn_tile("stereo_patch", hypothesis, 0, volume_.width, volume_.height);
  check_drawn_tile("stereo_patch", hypothesis, 1, map_.width, map_.height);
}

double StereoPatch::do_cost(const RenderedHypothesis& hypothesis) const {
  check_tiles(hypothesis);
  return 0.0 - sum_similarity(volume_, hypothesis.views[0], hypothesis.views[1], map_,
                              static_cast<float>(params_.r));  // not -0.0
}

std::unique_ptr<cuda::DeviceObjective> StereoPatch::do_on_device() const {
  return make_device_objective(params_);
}

std::int64_t StereoPatch::do_residual_count() const {
  return std::int64_t{volume_.width} * volume_.height;
}

void StereoPatch::do_write_residuals(const RenderedHypothesis& hypothesis,
                                     std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double StereoPatch::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                          std::span<float> residuals) const {
  check_tiles(hypothesis);
  return 0.0 - stereo_patch::write_residuals(volume_, hypothesis.views[0], hypothesis.views[1],
                                             map_, static_cast<float>(params_.r), residuals);
}

std::span<const int> StereoPatch::do_pixel_views() const {
  static constexpr std::array<int, 1> kViews{0};
  return kViews;
}

void StereoPatch::do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t,
                                  std::span<float> residuals, std::span<float> slopes) const {
  check_tiles(hypothesis);
  stereo_patch::write_slopes(volume_, hypothesis.views[0], hypothesis.views[1], map_,
                             static_cast<float>(params_.r), residuals, slopes);
}

}  // namespace hypotrack::stereo_patch
