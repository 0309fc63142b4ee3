#include <fmt/format.h>

#include <memory>

#include "check_scene.hpp"
#include "commands.hpp"

namespace hypotrack::app {
namespace {

int validate_scene(const SceneOptions& options, const CommonOptions& common, bool print) {
  PluginLoader plugins(common.plugin_path);
  const CheckedScene scene = check_scene(options.scene, options.set, plugins);
  if (print)
    fmt::print("{}", scene.resolved);
  else
    fmt::print("{}: ok: {} model{}, {} parameters, {} camera{}, {}\n", options.scene.string(),
               scene.models, scene.models == 1 ? "" : "s", scene.parameters, scene.cameras,
               scene.cameras == 1 ? "" : "s", scene.backend);
  return 0;
}

}  // namespace

void add_validate_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<SceneOptions>();
  auto print = std::make_shared<bool>(false);
  const Command command = root.add_command("validate", "Check a scene without tracking");
  add_scene_options(command, *options);
  command.add("--print", print.get(), "Print the scene with every parameter resolved");
  command.on_call(
      [=, &common, &exit_code] { exit_code = validate_scene(*options, common, *print); });
}

}  // namespace hypotrack::app
