#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
namespace cuda {
struct DeviceObservation;
}
}  // namespace hypotrack

namespace hypotrack::rgbd_depth {

/// Throws DataError unless the views fit the objective. At least one view must have depth. Every
/// view with depth must have what `foreground` needs, in images of its tile's size and of the right
/// type.
void check(const Observation& observation, Foreground foreground);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

}  // namespace hypotrack::rgbd_depth
