#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
}  // namespace hypotrack

namespace hypotrack::stereo_patch {

/// What a pixel counts in a frame, in 0..1: 1 or, where full_at_difference says so and the frame
/// knows how its views differ, (color_difference / full_at_difference)^2 up to 1, stepped(). The
/// square: what colours say of a pose is worth as much as the inverse of their noise's variance.
double share_of(const Settings& settings, const Observation& observation);

}  // namespace hypotrack::stereo_patch
