#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
}  // namespace hypotrack

namespace hypotrack::stereo_patch {

/// Returns the weight of a pixel in a frame, in 0..1. It is 1 unless full_at_difference is set and
/// the frame knows the difference of its views. Then it is (color_difference /
/// full_at_difference)^2, quantize_log() and at most 1. The square is used because colours count by
/// the inverse of their noise's variance.
double share_of(const Settings& settings, const Observation& observation);

}  // namespace hypotrack::stereo_patch
