#pragma once

#include "cost/cuda/work_of_rows.hpp"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {

/// Returns the cameras of an observation in the kernels' form. Throws DeviceError on more than
/// kMaxViews views.
FrameLayout frame_layout(const Observation& observation, const WorkEnds& work = even_work());

}  // namespace hypotrack::cuda
