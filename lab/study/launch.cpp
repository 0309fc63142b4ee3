#include "lab/study/launch.hpp"

#include <fmt/format.h>

namespace hypotrack::study {

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
  for (const Change& change : changes) set(change.assignment());
  return arguments;
}

}  // namespace hypotrack::study
