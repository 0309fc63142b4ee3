#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A sequence to collect poses from.
struct PoseSequence {
  std::filesystem::path scene;         ///< with a ground truth
  std::vector<std::string> overrides;  ///< as --set has them
  int frames = 150;                    ///< at most
  int number = 0;                      ///< KnownPose::sequence; also the seed of displacements
};

/// Called after each frame; returns whether to go on.
using PoseProgress = std::function<bool(int frame)>;

/// Collects poses of a scene's models with their measures. The tracker finds some of them, and
/// recoveries others, without knowledge of where the models are. The rest are the true poses, and
/// those displaced by up to 200 mm. Measures are taken twice, before and after the looks of the
/// models were learned. Throws DataError if the source has no ground truth or less than two views.
std::vector<KnownPose> collect_known_poses(const PoseSequence& sequence, PluginLoader& plugins,
                                           const PoseProgress& progress = {});

}  // namespace internal
}  // namespace hypotrack
