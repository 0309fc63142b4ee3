#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "notes.hpp"
#include "output/run_output.hpp"
#include "session/opened_scene.hpp"
#include "start_drawing.hpp"
#include "tell.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack::app {
namespace {

struct ValidateOptions {
  SceneOptions scene;
  bool print = false;
  std::optional<std::filesystem::path> draw;
};

/// Reads the first frame; if it is to be drawn, the first usable one.
std::optional<Frame> first_frame(Source& source, bool draw) {
  std::optional<Frame> frame = source.next();
  while (frame && !frame->problem.empty()) {
    tell("frame {} cannot be used: {}\n", frame->index, frame->problem);
    if (!draw) break;
    frame = source.next();
    if (!frame) throw DataError("no frame of the source can be used, so there is none to draw");
  }
  return frame;
}

/// Opens everything that a run would open, checks the first frame and draws the start on it.
int validate_scene(const ValidateOptions& options, const CommonOptions& common) {
  if (options.draw) check_picture_file(*options.draw);
  PluginLoader plugins(common.plugin_path);
  OpenedScene session = open_scene(options.scene.scene, options.scene.set, plugins);
  check_outputs(session.outputs);
  const auto first = first_frame(*session.source, options.draw.has_value());
  if (!first) throw DataError("the source has no frame");
  const bool usable = first->problem.empty();
  const int parameters = session.scene->dimension();
  const std::size_t models = session.scene->items().size();
  const std::size_t cameras = session.parts.cameras.size();
  (void)make_fixed_lag_smoother(session);
  const Eigen::VectorXd start =
      usable ? initial_state(session, *first, &session.notes) : session.scene->rest_state();
  const bool looks = session.parts.begins_by_looking;
  const TileSettings tile = session.parts.tile;
  const auto draw = [&](const StartToDraw& drawn) {
    write_picture(*options.draw,
                  draw_start(*session.scene, session.source->cameras(), tile, *first, drawn));
    tell("{}: {}\n", options.draw->string(), drawn.caption.front());
  };
  // Before anything can fail because of the start: the picture shows why.
  if (options.draw && !looks) draw(given_start(session, start, *first));
  SceneTracker tracker(*session.scene, std::move(session.parts), start, session.seed);
  if (usable) {
    tracker.check(*first);
    if (options.draw && looks) draw(found_start(session, tracker, *first));
    for (const std::string& note : session.notes) tell("note: {}\n", note);
    tell_notes(*session.source, tracker, *first);
  }
  if (options.print)
    fmt::print("{}", session.resolved);
  else
    fmt::print("{}: ok: {} model{}, {} parameters, {} camera{}, {}\n", options.scene.scene.string(),
               models, models == 1 ? "" : "s", parameters, cameras, cameras == 1 ? "" : "s",
               tracker.backend());
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
