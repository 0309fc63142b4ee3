#include "settings.hpp"

#include <algorithm>

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::stereo_color {

double beta_of(const Settings& settings, const Observation& observation) {
  if (settings.beta_by_difference <= 0 || observation.context.color_difference <= 0)
    return settings.beta;
  const double wanted = settings.beta_by_difference / observation.context.color_difference;
  // StereoColor checks the bounds.
  return std::clamp(quantize_log(wanted), settings.beta_min, settings.beta_max);
}

void check(const Observation& observation) { check_color_pair("stereo_color", observation); }

void check(const cuda::DeviceObservation& observation) {
  check_color_pair("stereo_color", *observation.header,
                   {observation.tiles[0].has_color, observation.tiles[1].has_color});
}

}  // namespace hypotrack::stereo_color
