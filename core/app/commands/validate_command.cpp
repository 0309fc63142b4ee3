#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "check_scene.hpp"
#include "commands.hpp"

namespace hypotrack::app {
namespace {

struct ValidateOptions {
  SceneOptions scene;
  bool print = false;
  std::optional<std::filesystem::path> draw;
};

int validate_scene(const ValidateOptions& options, const CommonOptions& common) {
  PluginLoader plugins(common.plugin_path);
  const CheckedScene scene =
      check_scene(options.scene.scene, options.scene.set, plugins, options.draw);
  if (options.print)
    fmt::print("{}", scene.resolved);
  else
    fmt::print("{}: ok: {} model{}, {} parameters, {} camera{}, {}\n", options.scene.scene.string(),
               scene.models, scene.models == 1 ? "" : "s", scene.parameters, scene.cameras,
               scene.cameras == 1 ? "" : "s", scene.backend);
  return 0;
}

}  // namespace

void add_validate_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<ValidateOptions>();
  const Command command = root.add_command("validate", "Check a scene without tracking");
  add_scene_options(command, options->scene);
  command.add("--print", &options->print, "Print the scene with every parameter resolved");
  command.add("--draw", &options->draw,
              "Picture to write of the start, drawn over both views of the first frame",
              {.check = file_name(), .value_name = "FILE.png"});
  command.on_call([=, &common, &exit_code] { exit_code = validate_scene(*options, common); });
}

}  // namespace hypotrack::app
