#pragma once

#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

std::unique_ptr<cuda::DeviceObjective> make_nearest(const Settings& settings);
std::unique_ptr<cuda::DeviceObjective> make_bilinear(const Settings& settings);

}  // namespace hypotrack::stereo_color
