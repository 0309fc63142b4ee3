#include "beta.hpp"

#include <algorithm>
#include <cmath>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::stereo_color {

double beta_of(const Settings& settings, const Observation& observation) {
  if (settings.beta_by_difference <= 0 || observation.color_difference <= 0) return settings.beta;
  constexpr double kStep = 1.1;
  const double wanted = settings.beta_by_difference / observation.color_difference;
  const double stepped = std::pow(kStep, std::round(std::log(wanted) / std::log(kStep)));
  return std::clamp(stepped, settings.beta_min, settings.beta_max);  // StereoColor checks them
}

double beta_of(const Settings& settings, const cuda::DeviceObservation& observation) {
  return beta_of(settings, *observation.header);
}

}  // namespace hypotrack::stereo_color
