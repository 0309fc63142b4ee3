#pragma once

#include <functional>
#include <memory>

#include "hypotrack/cuda/device_objective.hpp"
#include "motion_term.hpp"

namespace hypotrack::plausible_motion {

/// The term of a frame, in host memory until the next call.
using TermOfFrame = std::function<MotionTerm(const Observation&)>;

/// The term on the GPU, null in a build without CUDA.
std::unique_ptr<cuda::DeviceObjective> on_device(TermOfFrame term_of_frame);

/// What `plugins info` shows: "residuals", and what the GPU has of it in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::plausible_motion
