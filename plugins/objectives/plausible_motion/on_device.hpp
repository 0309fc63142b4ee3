#pragma once

#include <functional>
#include <memory>

#include "hypotrack/gpu/device_objective.hpp"
#include "motion_term.hpp"

namespace hypotrack::plausible_motion {

/// Returns the term of a frame, in host memory that is valid until the next call.
using TermOfFrame = std::function<MotionTerm(const Observation&)>;

/// Makes the term on the GPU; null in a build without CUDA.
std::unique_ptr<cuda::DeviceObjective> on_device(TermOfFrame term_of_frame);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::plausible_motion
