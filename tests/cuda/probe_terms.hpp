#pragma once

#include <memory>

#include "hypotrack/cuda/device_objective.hpp"

namespace hypotrack::test {

inline constexpr float kProbeTolerance = 0.003f;  // metres

std::unique_ptr<cuda::DeviceObjective> covered_probe_on_device();
std::unique_ptr<cuda::DeviceObjective> seen_probe_on_device(bool uncovered);

}  // namespace hypotrack::test
