#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
struct TileCamera;
namespace cuda {
struct DeviceObservation;
struct DeviceTile;
}  // namespace cuda
}  // namespace hypotrack

namespace hypotrack::skin {

/// Rule that decides foreground in a view, on the CPU and with CUDA.
enum class Rule { none, color, mask, depth };

/// Returns the rule for a view; `none` if it lacks the images that the rule needs.
Rule rule_of(Foreground foreground, bool has_color, bool has_mask, bool has_depth);
Rule rule_of(Foreground foreground, const cuda::DeviceTile& tile);

/// Depths z along a camera's axis, metres.
struct DepthRange {
  float nearest = 0, farthest = 0;
};

/// Throws DataError unless a view has the images that decide foreground, and all images have their
/// tile's size and type.
void check(const Observation& observation, Foreground foreground);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

/// Returns the range of the scene's depths in a camera, posed in observation.start and widened by
/// `margin` metres at both ends.
DepthRange depth_range(const Observation& observation, const TileCamera& camera, double margin);

}  // namespace hypotrack::skin
