#pragma once

#include "hypotrack/observation.hpp"
#include "settings.hpp"

namespace hypotrack::cuda {
struct DeviceObservation;
}

namespace hypotrack::skin {

/// Throws DataError unless a view has what tells foreground, and images that have their tile's size
/// and type.
void check(const Observation& observation, Foreground foreground);
/// The same for a frame on the device, whose images cannot be of another size or type.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

}  // namespace hypotrack::skin
