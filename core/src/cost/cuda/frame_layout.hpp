#pragma once

#include "cost/cuda/work_of_rows.hpp"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {

/// The cameras of an observation as kernels see them. Throws DeviceError on more than kMaxViews
/// views.
FrameLayout frame_layout(const Observation& observation, const WorkEnds& work = even_work());

}  // namespace hypotrack::cuda
