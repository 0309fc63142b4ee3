#include "checks.hpp"

#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::stereo_color {

void check(const Observation& observation) { check_color_pair("stereo_color", observation); }

void check(const cuda::DeviceObservation& observation) {
  check_color_pair("stereo_color", *observation.header,
                   {observation.tiles[0].has_color, observation.tiles[1].has_color});
}

}  // namespace hypotrack::stereo_color
