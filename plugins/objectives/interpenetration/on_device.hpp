#pragma once

#include <memory>

#include "collision_term.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::interpenetration {

/// Makes the term on the GPU; null in a build without CUDA. The host memory of `term` must outlive
/// it.
std::unique_ptr<cuda::DeviceObjective> on_device(const CollisionTerm& term);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::interpenetration
