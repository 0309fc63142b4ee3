#include "lab/study/launch.hpp"

#include <fmt/format.h>

#include <utility>

#include "run/crew/crew.hpp"

namespace hypotrack::study::internal {

std::vector<std::string> settings_of(const std::vector<Change>& changes, const Plan& plan,
                                     const Launch& launch) {
  std::vector<std::string> settings{fmt::format("evaluate.threads={}", launch.threads),
                                    fmt::format("output.overlay={}", plan.study.overlay)};
  if (plan.study.trace) settings.emplace_back("output.trace=true");
  for (const Change& change : changes) settings.push_back(change.assignment());
  return settings;
}

std::vector<std::string> scene_arguments(const std::string& subcommand,
                                         const std::filesystem::path& scene,
                                         const std::vector<Change>& changes, const Plan& plan,
                                         const Launch& launch) {
  std::vector<std::string> arguments;
  for (const auto& folder : launch.plugin_path)
    arguments.insert(arguments.end(), {"--plugin-path", folder.string()});
  arguments.insert(arguments.end(), {subcommand, scene.string()});
  for (const std::string& setting : settings_of(changes, plan, launch))
    arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

Subprocess::Command study_command(const Launch& launch, const Plan& plan,
                                  std::vector<std::string> arguments, std::filesystem::path log) {
  Subprocess::Command command{launch.program, std::move(arguments)};
  command.directory = plan.study.directory;
  command.output = command.errors = std::move(log);
  command.variables = driver_variables(launch.threads);
  return command;
}

CrewSettings crew_settings(const Launch& launch, const Plan& plan) {
  return {.program = launch.program,
          .plugin_path = launch.plugin_path,
          .directory = plan.study.directory,
          .variables = driver_variables(launch.threads),
          .gpus = launch.gpus,
          .jobs = launch.jobs,
          .time_limit_s = launch.time_limit_s};
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
