#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "base/exported.hpp"
#include "session/opened_scene.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A scene with `shape.estimate_s`, ready to be tracked. Its models have the shape found in the
/// first seconds. Its source starts with the frames in which it was found.
struct EstimatedScene {
  OpenedScene first;  ///< the one that made the source; outlives `scene`
  ShapeEstimate estimate;
  OpenedScene scene;
};

/// Estimates the shape from the first `settings.seconds` of a scene's source and reopens the scene
/// with it. Holds those frames in memory. Throws what estimate_shape() throws.
EstimatedScene open_estimated(const SceneInput& scene, std::span<const std::string> overrides,
                              PluginLoader& plugins, const ShapeProgress& progress = {});

}  // namespace internal
}  // namespace hypotrack
