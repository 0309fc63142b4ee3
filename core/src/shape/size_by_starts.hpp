#pragma once

#include "base/exported.hpp"
#include "session/opened_scene.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Estimates how large the models are, from what the scene's starts see in up to twice
/// `settings.frames` frames of its source: the most probable size for the median of their sizes.
/// Keeps the size given, and uses no frame, if they see the models well in fewer than 3. Throws
/// ConfigError if no start recognises a model or `settings.parameters` lacks `scale`.
ShapeEstimate size_by_starts(OpenedScene session, const ShapeEstimateSettings& settings);

}  // namespace internal
}  // namespace hypotrack
