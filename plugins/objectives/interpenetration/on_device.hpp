#pragma once

#include <memory>

#include "collision_term.hpp"
#include "hypotrack/cuda/device_objective.hpp"

namespace hypotrack::interpenetration {

/// The term on the GPU, null in a build without CUDA; what the term points to on the host outlives
/// it.
std::unique_ptr<cuda::DeviceObjective> on_device(const CollisionTerm& term);

/// What `plugins info` shows: "residuals", and what the GPU has of it in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::interpenetration
