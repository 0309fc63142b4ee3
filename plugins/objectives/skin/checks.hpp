#pragma once

#include "hypotrack/plugin/observation.hpp"
#include "settings.hpp"

namespace hypotrack::cuda {
struct DeviceObservation;
}

namespace hypotrack::skin {

/// Throws DataError unless a view has the images that decide foreground, and all images have their
/// tile's size and type.
void check(const Observation& observation, Foreground foreground);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

}  // namespace hypotrack::skin
