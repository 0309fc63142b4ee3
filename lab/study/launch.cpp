#include "lab/study/launch.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

namespace hypotrack::study::internal {

std::vector<std::string> scene_arguments(const std::string& subcommand,
                                         const std::filesystem::path& scene,
                                         const std::vector<Change>& changes, const Plan& plan,
                                         const Launch& launch) {
  std::vector<std::string> arguments;
  for (const auto& folder : launch.plugin_path)
    arguments.insert(arguments.end(), {"--plugin-path", folder.string()});
  arguments.insert(arguments.end(), {subcommand, scene.string()});
  const auto set = [&](const std::string& assignment) {
    arguments.insert(arguments.end(), {"--set", assignment});
  };
  set(fmt::format("evaluate.threads={}", launch.threads));
  set(fmt::format("output.overlay={}", plan.study.overlay));
  if (plan.study.trace) set("output.trace=true");
  for (const Change& change : changes) set(change.assignment());
  return arguments;
}

Subprocess::Command study_command(const Launch& launch, const Plan& plan,
                                  std::vector<std::string> arguments, std::filesystem::path log) {
  Subprocess::Command command{launch.program, std::move(arguments)};
  command.directory = plan.study.directory;
  command.output = command.errors = std::move(log);
  // Otherwise Mesa's software rasteriser starts a thread per core in every run.
  constexpr const char* kMesaThreads = "LP_NUM_THREADS";
  if (!std::getenv(kMesaThreads))
    command.variables = {fmt::format("{}={}", kMesaThreads, launch.threads)};
  return command;
}

Subprocess::Command work_command(const Launch& launch, const Plan& plan,
                                 std::vector<std::string> arguments, const RunFolder& folder) {
  if (plan.study.frames)
    arguments.insert(arguments.end(), {"--frames", fmt::format("{}", *plan.study.frames)});
  auto command = study_command(launch, plan, std::move(arguments), folder.log());
  command.descriptors = {{folder.lock_descriptor(), folder.lock_descriptor()}};
  return command;
}

}  // namespace hypotrack::study::internal
