#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "base/subprocess.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/run_folder.hpp"
#include "run/crew/gpu_worker.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Settings for starting the processes of a study.
struct Launch {
  std::filesystem::path program;                   ///< `hypotrack`
  std::vector<std::filesystem::path> plugin_path;  ///< absolute
  int jobs = 1;                                    ///< runs at the same time
  double time_limit_s = 0;                         ///< of a run; 0: none
  int threads = 1;                                 ///< threads of each run
  int spare_cores = 0;                             ///< that no run uses
  std::string pictures = "png";                    ///< format of recordings: png or ppm
  std::vector<int> gpus = {};                      ///< for all runs; empty: each takes its scene's
};

/// Returns the settings of a run: those of all runs (threads, overlay), then the changes.
std::vector<std::string> settings_of(const std::vector<Change>& changes, const Plan& plan,
                                     const Launch& launch);

/// Returns the arguments of a subcommand that takes a scene: the scene, then settings_of().
std::vector<std::string> scene_arguments(const std::string& subcommand,
                                         const std::filesystem::path& scene,
                                         const std::vector<Change>& changes, const Plan& plan,
                                         const Launch& launch);

/// Returns the command of a process of a study, whose output goes to a log.
Subprocess::Command study_command(const Launch& launch, const Plan& plan,
                                  std::vector<std::string> arguments, std::filesystem::path log);

/// Returns the settings of a crew that makes the study's runs.
CrewSettings crew_settings(const Launch& launch, const Plan& plan);

/// Returns the command of a process that works in a run's folder, keeps its lock, and stops after
/// the study's number of frames.
Subprocess::Command work_command(const Launch& launch, const Plan& plan,
                                 std::vector<std::string> arguments, const RunFolder& folder);

}  // namespace internal
}  // namespace hypotrack::study
