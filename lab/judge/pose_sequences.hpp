#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/judge/known_poses.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Plans sequences of scenes in turn. Those that are rendered (`type: synthetic`) differ in motion
/// (where the source is `random`), light, noise, blur, gain and background, by their numbers.
/// Others give one sequence each. `overrides` change all scenes, and win.
std::vector<PoseSequence> plan_pose_sequences(std::span<const std::filesystem::path> scenes,
                                              const std::vector<std::string>& overrides, int count,
                                              int frames);

/// Returns the types of the models of scenes, each once.
std::vector<std::string> model_types(std::span<const std::filesystem::path> scenes,
                                     const std::vector<std::string>& overrides);

}  // namespace internal
}  // namespace hypotrack
