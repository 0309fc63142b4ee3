#pragma once

#include <memory>

#include "cuda/color_term.cuh"
#include "cuda/feature_maps.hpp"
#include "hypotrack/gpu/pixel_objective.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// The objective on the device. The templates are instantiated in one source file per lookup.
template <bool kBilinear, bool kBoth>
class DeviceStereoColor final : public cuda::PixelObjective<ColorTerm<kBilinear, kBoth>> {
 public:
  explicit DeviceStereoColor(const Settings& settings) : settings_(settings), maps_(settings) {}

 private:
  using Term = ColorTerm<kBilinear, kBoth>;

  Term make_term(const cuda::DeviceObservation& observation, cuda::Stream stream) override {
    check(observation);
    maps_.enqueue(observation, stream);
    Term term{};
    for (int i = 0; i < 2; ++i) term.features[i] = maps_.of_view(i);
    term.curve = {static_cast<float>(beta_of(settings_, *observation.header)) * Term::kUnit,
                  static_cast<float>(settings_.coverage_penalty),
                  settings_.falloff == Falloff::gaussian};
    term.tolerance = static_cast<float>(settings_.r);
    term.direction = settings_.direction;
    term.aggregation = settings_.aggregation;
    return term;
  }

  Settings settings_;
  FeatureMaps maps_;
};

template <bool kBilinear>
std::unique_ptr<cuda::DeviceObjective> make_with_lookup(const Settings& settings) {
  if (settings.direction == Direction::both) {
    return std::make_unique<DeviceStereoColor<kBilinear, true>>(settings);
  }
  return std::make_unique<DeviceStereoColor<kBilinear, false>>(settings);
}

/// Returns make_with_lookup<true>().
std::unique_ptr<cuda::DeviceObjective> make_bilinear(const Settings& settings);

}  // namespace hypotrack::stereo_color
