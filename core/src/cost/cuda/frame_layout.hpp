#pragma once

#include "base/exported.hpp"
#include "cost/cuda/load_balance.hpp"
#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the cameras of an observation in the kernels' form. Throws DeviceError on more than
/// kMaxViews views.
FrameLayout frame_layout(const Observation& observation, const BandEnds& bands = even_bands());

}  // namespace internal
}  // namespace hypotrack::cuda
