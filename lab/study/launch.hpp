#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/study/plan.hpp"

namespace hypotrack::study {

/// How the processes of a study are started.
struct Launch {
  std::filesystem::path program;                   ///< `hypotrack`
  std::vector<std::filesystem::path> plugin_path;  ///< absolute
  int jobs = 1;                                    ///< at the same time
  int threads = 1;                                 ///< of each
};

/// The arguments of a subcommand that takes a scene: the scene, and what changes it: first what the
/// study sets for all runs (threads, overlay), then the changes.
std::vector<std::string> scene_arguments(const std::string& subcommand,
                                         const std::filesystem::path& scene,
                                         const std::vector<Change>& changes, const Plan& plan,
                                         const Launch& launch);

}  // namespace hypotrack::study
