#pragma once

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {

/// The cameras of an observation as kernels see them. Throws DeviceError on more than kMaxViews
/// views.
FrameLayout frame_layout(const Observation& observation);

}  // namespace hypotrack::cuda
