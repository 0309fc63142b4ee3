#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
namespace cuda {
struct DeviceObservation;
}
}  // namespace hypotrack

namespace hypotrack::rgbd_depth {

/// Throws DataError unless a view has depth, and every view that has some also has what
/// `foreground` needs, and images of its tile's size and of the right type.
void check(const Observation& observation, Foreground foreground);
/// The same for a frame on the device, whose images cannot be of another size or type.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

}  // namespace hypotrack::rgbd_depth
