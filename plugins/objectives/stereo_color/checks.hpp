#pragma once

namespace hypotrack {
struct Observation;
namespace cuda {
struct DeviceObservation;
}
}  // namespace hypotrack

namespace hypotrack::stereo_color {

/// Throws DataError unless there are two views with colour, in tiles of 2x2 pixels or more, and
/// images of their tile's size and type.
void check(const Observation& observation);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation);

}  // namespace hypotrack::stereo_color
