#pragma once

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/status_metrics.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack {

/// Returns a solution's verdicts on the frame and on each model that has landmarks.
HYPOTRACK_API FrameVerdicts verdicts_of(const Scene& scene, const Solution& solution);

}  // namespace hypotrack
