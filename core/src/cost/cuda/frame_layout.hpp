#pragma once

#include "cost/cuda/load_balance.hpp"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {

/// Returns the cameras of an observation in the kernels' form. Throws DeviceError on more than
/// kMaxViews views.
FrameLayout frame_layout(const Observation& observation, const BandEnds& bands = even_bands());

}  // namespace hypotrack::cuda
