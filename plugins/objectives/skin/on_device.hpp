#pragma once

#include <memory>

#include "settings.hpp"

namespace hypotrack {
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

namespace hypotrack::skin {

/// The objective on the GPU; null in a build without CUDA. Touches no device before it prepares a
/// frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// What `plugins info` shows: "residuals", and what the GPU has of it in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::skin
