#include <algorithm>

#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

double beta_of(const Settings& settings, const Observation& observation) {
  if (settings.beta_by_difference <= 0 || observation.context.color_difference <= 0)
    return settings.beta;
  const double wanted = settings.beta_by_difference / observation.context.color_difference;
  // StereoColor checks the bounds.
  return std::clamp(quantize_log(wanted), settings.beta_min, settings.beta_max);
}

}  // namespace hypotrack::stereo_color
