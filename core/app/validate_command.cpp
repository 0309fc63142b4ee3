#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "notes.hpp"
#include "output/run_output.hpp"
#include "session/opened_scene.hpp"
#include "tell.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack::app {
namespace {

/// Opens everything that a run would open and checks the first frame.
int validate_scene(const SceneOptions& options, const CommonOptions& common, bool print) {
  PluginLoader plugins(common.plugin_path);
  OpenedScene session = open_scene(options.scene, options.set, plugins);
  check_outputs(session.outputs);
  const auto first = session.source->next();
  if (!first) throw DataError("the source has no frame");
  const bool usable = first->problem.empty();
  if (!usable) tell("frame {} cannot be used: {}\n", first->index, first->problem);
  const int parameters = session.scene->dimension();
  const std::size_t models = session.scene->items().size();
  const std::size_t cameras = session.parts.cameras.size();
  (void)make_fixed_lag_smoother(session);
  SceneTracker tracker(*session.scene, std::move(session.parts),
                       usable ? initial_state(session, *first) : session.scene->rest_state(),
                       session.seed);
  if (usable) {
    tracker.check(*first);
    for (const std::string& note : session.notes) tell("note: {}\n", note);
    tell_notes(*session.source, tracker, *first);
  }
  if (print)
    fmt::print("{}", session.resolved);
  else
    fmt::print("{}: ok: {} model{}, {} parameters, {} camera{}, {}\n", options.scene.string(),
               models, models == 1 ? "" : "s", parameters, cameras, cameras == 1 ? "" : "s",
               tracker.backend());
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
