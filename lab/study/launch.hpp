#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "base/subprocess.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/run_folder.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Settings for starting the processes of a study.
struct Launch {
  std::filesystem::path program;                   ///< `hypotrack`
  std::vector<std::filesystem::path> plugin_path;  ///< absolute
  int jobs = 1;                                    ///< processes at the same time
  double time_limit_s = 0;                         ///< of a run; 0: none
  int threads = 1;                                 ///< threads of each process
};

/// Returns the arguments of a subcommand that takes a scene: the scene, then the settings of all
/// runs (threads, overlay), then the changes.
std::vector<std::string> scene_arguments(const std::string& subcommand,
                                         const std::filesystem::path& scene,
                                         const std::vector<Change>& changes, const Plan& plan,
                                         const Launch& launch);

/// Returns the command of a process of a study, whose output goes to a log.
Subprocess::Command study_command(const Launch& launch, const Plan& plan,
                                  std::vector<std::string> arguments, std::filesystem::path log);

/// Returns the command of a process that works in a run's folder, keeps its lock, and stops after
/// the study's number of frames.
Subprocess::Command work_command(const Launch& launch, const Plan& plan,
                                 std::vector<std::string> arguments, const RunFolder& folder);

}  // namespace internal
}  // namespace hypotrack::study
