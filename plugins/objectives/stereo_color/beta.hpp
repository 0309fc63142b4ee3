#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
}  // namespace hypotrack

namespace hypotrack::stereo_color {

/// Returns the beta of a frame. It is settings.beta unless beta_by_difference is set and the frame
/// knows the difference of its views. Then it is beta_by_difference / color_difference,
/// quantize_log() and clamped to beta_min .. beta_max.
double beta_of(const Settings& settings, const Observation& observation);

}  // namespace hypotrack::stereo_color
