#pragma once

#include "settings.hpp"

namespace hypotrack {
struct Observation;
}  // namespace hypotrack

namespace hypotrack::stereo_color {

/// The beta of a frame: that of the settings or, where beta_by_difference says so and the frame
/// knows how its views differ, beta_by_difference / color_difference within beta_min .. beta_max,
/// stepped().
double beta_of(const Settings& settings, const Observation& observation);

}  // namespace hypotrack::stereo_color
