#include "share.hpp"

#include <algorithm>

#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::stereo_patch {

double share_of(const Settings& settings, const Observation& observation) {
  if (settings.full_at_difference <= 0 || observation.context.color_difference <= 0) return 1;
  const double ratio = observation.context.color_difference / settings.full_at_difference;
  return std::min(quantize_log(ratio * ratio), 1.0);
}

}  // namespace hypotrack::stereo_patch
