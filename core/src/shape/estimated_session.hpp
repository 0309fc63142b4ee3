#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "hypotrack/export.hpp"
#include "session/session.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack {

/// A scene with `shape.estimate_s`, ready to be tracked: its models have the shape found in the
/// first seconds, and its source begins with the frames that it was found in.
struct EstimatedSession {
  Session first;  ///< that the source was made for; outlives `session`
  ShapeEstimate estimate;
  Session session;
};

/// Reads the first `settings.seconds` of a scene's source (held in memory), estimates the shape and
/// opens the scene again with it. Throws what estimate_shape() throws.
HYPOTRACK_API EstimatedSession open_estimated(const std::filesystem::path& scene_file,
                                              std::span<const std::string> overrides,
                                              PluginLoader& plugins,
                                              const ShapeProgress& progress = {});

}  // namespace hypotrack
