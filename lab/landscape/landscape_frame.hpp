#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/stop.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/landscape/landscape.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A frame to slice the cost of, and changes to its scene.
struct LandscapeRequest {
  std::filesystem::path scene;
  std::span<const std::string> overrides;
  int frame = 0;
  LandscapeSettings settings;
};

struct FrameLandscape {
  Landscape landscape;
  bool around_truth = false;  ///< false: around the tracked pose
};

/// Slices the cost of a frame around the truth or, in a source without true states, around the pose
/// to which the scene's tracker comes. Prepares the frame as a search from there does. Throws
/// DataError if there is no such frame, or neither pose; Stopped when `stop` returns true.
FrameLandscape landscape_of_frame(const LandscapeRequest& request, PluginLoader& plugins,
                                  const StopTest& stop);

}  // namespace internal
}  // namespace hypotrack
