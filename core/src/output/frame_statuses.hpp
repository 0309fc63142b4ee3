#pragma once

#include "base/exported.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/status_metrics.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns a solution's statuses of the frame and of each model that has landmarks.
FrameStatuses statuses_of(const Scene& scene, const Solution& solution);

}  // namespace internal
}  // namespace hypotrack
