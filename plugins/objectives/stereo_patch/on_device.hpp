#pragma once

#include <memory>

#include "settings.hpp"

namespace hypotrack {
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

namespace hypotrack::stereo_patch {

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::stereo_patch
