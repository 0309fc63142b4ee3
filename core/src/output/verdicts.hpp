#pragma once

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/status_metrics.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// Returns what a solution says of a frame and of each model that has landmarks.
HYPOTRACK_API FrameVerdicts verdicts_of(const Scene& scene, const Solution& solution);

}  // namespace hypotrack
