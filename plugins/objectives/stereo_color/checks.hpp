#pragma once

namespace hypotrack {
struct Observation;
namespace cuda {
struct DeviceObservation;
}
}  // namespace hypotrack

namespace hypotrack::stereo_color {

/// Throws DataError unless there are two views with colour, of tiles of 2x2 pixels or more, and
/// images that have their tile's size and type.
void check(const Observation& observation);
/// The same for a frame on the device, whose images cannot be of another size or type.
void check(const cuda::DeviceObservation& observation);

}  // namespace hypotrack::stereo_color
